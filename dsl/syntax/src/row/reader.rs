//! The parts of statements: names, numbers, capabilities and formulas.
//!
//! Input: a line. Output: the parsed part, or an error.

use fragbuf_model::{Code, Diagnostic, Diagnostics, SourceSpan, Spanned, codes, mangled};
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{
    Capability, DescriptionValues, Feature, Formula, FormulaError, Permits, RowItem, RowItemSpan,
};

use super::former;
use super::line::Line;
use crate::report::Stop;
use crate::unknown_name;

/// A parsed part, or the mark that an error was reported.
pub(super) type Read<T> = Result<T, Stop>;

/// The operators of formulas, for messages.
const OPERATORS: &str = "`+ - * /`, `== != < <= > >=`, `&& ||`";

/// The errors and spans so far.
pub(super) struct Reader {
    pub(super) diagnostics: Diagnostics,
    /// The spans of names and formulas that are valid in the row, for errors that depend on a description.
    pub(super) item_spans: Vec<RowItemSpan>,
}

impl Reader {
    /// Parses a name. The message says that `what` is expected, and shows the `shape` of the statement.
    pub(super) fn name(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<Spanned<String>> {
        match line.name() {
            Some(name) => Ok(name),
            None => self.unexpected(line, what, shape),
        }
    }

    /// Parses a name that is valid in WGSL and unused by generated code.
    pub(super) fn wgsl_name(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<Spanned<String>> {
        let name = self.name(line, what, shape)?;
        let plain = !name.value.contains('-') && !name.value.starts_with(|first: char| first.is_ascii_digit());
        if plain && mangled(&name.value) == name.value.as_str() {
            return Ok(name);
        }
        let message = format!("`{}` cannot be {what}", name.value);
        let help = "choose a name of letters, digits and `_` that neither WGSL nor generated code uses";
        self.stop(codes::INVALID_ROW, &name.span, message, help)
    }

    /// Parses a punctuation character.
    pub(super) fn punct(&mut self, line: &mut Line<'_>, character: char, shape: &str) -> Read<()> {
        if line.punct(character) { Ok(()) } else { self.unexpected(line, &format!("`{character}`"), shape) }
    }

    /// Parses an integer of 32 bits.
    pub(super) fn number(&mut self, line: &mut Line<'_>) -> Read<Spanned<u32>> {
        let name = self.name(line, "a number", "digits only, such as `8`")?;
        let Ok(number) = name.value.parse() else {
            let message = format!("expected an integer of 32 bits, found `{}`", name.value);
            return self.stop(codes::INVALID_ROW, &name.span, message, "write digits only, such as `8`");
        };
        Ok(Spanned::new(number, name.span))
    }

    /// Parses a list of capabilities.
    pub(super) fn capabilities(&mut self, line: &mut Line<'_>) -> Read<Vec<Capability>> {
        let mut capabilities = vec![self.capability(line)?];
        while line.punct(',') {
            capabilities.push(self.capability(line)?);
        }
        Ok(capabilities)
    }

    /// Parses a list of capabilities of other rows and features of targets.
    pub(super) fn requirements(&mut self, line: &mut Line<'_>) -> Read<(Vec<Capability>, Vec<Feature>)> {
        let (mut capabilities, mut features) = (Vec::new(), Vec::new());
        loop {
            let name = self.name(line, "a capability or a feature", "`mutual-exclusion`, `fragment-atomics`")?;
            match Feature::ALL.iter().find(|feature| feature.name() == name.value) {
                Some(feature) => features.push(*feature),
                None => capabilities.push(self.capability_of(&name, Feature::ALL)?),
            }
            if !line.punct(',') {
                return Ok((capabilities, features));
            }
        }
    }

    /// Parses a capability.
    pub(super) fn capability(&mut self, line: &mut Line<'_>) -> Read<Capability> {
        let name = self.name(line, "a capability", "`keeps-best`, `keeps-all`, `mutual-exclusion`")?;
        self.capability_of(&name, &[])
    }

    /// Parses a formula over the symbols of a description.
    pub(super) fn condition(&mut self, line: &mut Line<'_>) -> Read<Formula> {
        self.condition_with(line, Vec::new())
    }

    /// Parses a formula over the symbols of a description and these constants of the row.
    pub(super) fn condition_with(&mut self, line: &mut Line<'_>, constants: Vec<String>) -> Read<Formula> {
        let formula = line.formula(&[]);
        let symbols = DescriptionValues::symbols().map(|symbol| symbol.name.to_owned());
        let symbols: Vec<String> = symbols.chain(constants).collect();
        self.formula(&formula, &symbols)?;
        Ok(formula.value.into())
    }

    /// Returns the capability of this name. The help lists the `features` that are also valid here.
    fn capability_of(&mut self, name: &Spanned<String>, features: &[Feature]) -> Read<Capability> {
        let present = former::present(&name.value);
        if let Some(capability) = Capability::ALL.iter().find(|capability| capability.name() == present) {
            return Ok(*capability);
        }
        if Feature::ALL.iter().any(|feature| feature.name() == name.value) {
            let message = format!("`{}` is a feature of targets, not a capability of rows", name.value);
            let help = format!("remove it here; if the row needs it, write `//: requires {}`", name.value);
            return self.stop(codes::UNKNOWN_CAPABILITY, &name.span, message, help);
        }
        let capabilities = Capability::ALL.iter().map(|capability| capability.name());
        let known: Vec<String> = capabilities.chain(features.iter().map(|feature| feature.name())).collect();
        let message = format!("unknown capability `{}`", name.value);
        self.stop(codes::UNKNOWN_CAPABILITY, &name.span, message, unknown_name::help(&name.value, &known))
    }

    /// Returns what the name of a hazard permits.
    pub(super) fn permits(&mut self, name: &Spanned<String>) -> Read<Permits> {
        if let Some(Shorthand::Permits(permits)) = Shorthand::of(former::present(&name.value)) {
            return Ok(permits);
        }
        let known = Shorthand::ALL.into_iter().filter(|(_, one)| matches!(one, Shorthand::Permits(_)));
        let known: Vec<&str> = known.map(|(name, _)| name).collect();
        let message = format!("a hazard cannot permit `{}`", name.value);
        self.stop(codes::INVALID_ROW, &name.span, message, unknown_name::help(&name.value, &known))
    }

    /// Returns the value of a name in a table.
    pub(super) fn one_of<T: Copy>(&mut self, name: &Spanned<String>, table: &[(&str, T)], what: &str) -> Read<T> {
        let present = former::present(&name.value);
        if let Some((_, value)) = table.iter().find(|(key, _)| *key == present) {
            return Ok(*value);
        }
        let known: Vec<&str> = table.iter().map(|(name, _)| *name).collect();
        let message = format!("expected {what}, found `{}`", name.value);
        self.stop(codes::INVALID_ROW, &name.span, message, unknown_name::help(&name.value, &known))
    }

    /// Reports a formula that does not parse, uses other symbols, or has no value for any values of its symbols.
    pub(super) fn formula(&mut self, formula: &Spanned<String>, symbols: &[impl AsRef<str>]) -> Read<()> {
        let symbols: Vec<&str> = symbols.iter().map(AsRef::as_ref).collect();
        let Err(error) = check_formula(&Formula::from(formula.value.clone()), &symbols) else { return Ok(()) };
        let known = || {
            let symbols = symbols.join(", ");
            format!("the formula may use {symbols}, {OPERATORS}, min, max, ceil_div, pow2 and log2_ceil")
        };
        let (problem, help) = match &error {
            FormulaError::Unbound(symbol) => (format!("cannot use `{symbol}` in this formula"), known()),
            FormulaError::Malformed { text, .. } => (format!("`{text}` is not a formula"), known()),
            other => (other.to_string(), other.help().to_owned()),
        };
        self.stop(codes::INVALID_ROW, &formula.span, problem, help)
    }

    /// Records the span of a name or a formula.
    pub(super) fn record_span(&mut self, item: RowItem, source: &Spanned<String>) {
        let SourceSpan { line, column, length, .. } = source.span;
        self.item_spans.push(RowItemSpan { item, text: source.value.clone().into(), line, column, length });
    }

    /// Reports that `what` is expected in place of the next name or character.
    pub(super) fn unexpected<T>(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<T> {
        let message = format!("expected {what}, found {}", line.describe());
        let span = line.here();
        self.stop(codes::INVALID_ROW, &span, message, format!("write {shape}"))
    }

    /// Reports an error and stops parsing the line.
    pub(super) fn stop<T>(&mut self, code: Code, at: &SourceSpan, message: String, help: impl Into<String>) -> Read<T> {
        self.error(code, at, message, help);
        Err(Stop)
    }

    /// Reports an error.
    pub(super) fn error(&mut self, code: Code, at: &SourceSpan, message: String, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::new(code, at, message, help));
    }
}

/// Returns an error if a formula does not parse, uses other symbols, or has no value for any values of its symbols.
fn check_formula(formula: &Formula, symbols: &[&str]) -> Result<(), FormulaError> {
    let expression = formula.read()?;
    if let Some(symbol) = expression.symbols().into_iter().find(|symbol| !symbols.contains(symbol)) {
        return Err(FormulaError::Unbound(symbol.to_owned()));
    }
    expression.folded(&|_| None)?.polynomial(&|_| None)?;
    Ok(())
}
