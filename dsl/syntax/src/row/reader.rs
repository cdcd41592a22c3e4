//! The pieces that statements are made of, each read or reported.

use fragbuf_model::{Code, Diagnostic, Diagnostics, Origin, Spanned, codes, mangled};
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{Capability, Fact, Formula, FormulaError, Given, Permits, Place, Written};

use super::line::Line;
use crate::near;

/// A mistake was reported; the rest of the line is not worth reading.
pub(super) struct Stop;

pub(super) type Read<T> = Result<T, Stop>;

/// The operators of formulas, in the words of a message.
const OPERATORS: &str = "`+ - * /`, `== != < <= > >=`, `&& ||`";

/// The mistakes so far.
pub(super) struct Reader {
    pub(super) faults: Diagnostics,
    /// Names and formulas that are right as far as the row goes, for what only a description can tell.
    pub(super) places: Vec<Place>,
}

impl Reader {
    /// A word; `what` it is and the `shape` of the statement are for the message.
    pub(super) fn word(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<Spanned<String>> {
        match line.word() {
            Some(word) => Ok(word),
            None => self.unexpected(line, what, shape),
        }
    }

    /// A word that WGSL takes as a name and generated code leaves free.
    pub(super) fn name(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<Spanned<String>> {
        let word = self.word(line, what, shape)?;
        let plain = !word.value.contains('-') && !word.value.starts_with(|first: char| first.is_ascii_digit());
        if plain && mangled(&word.value) == word.value.as_str() {
            return Ok(word);
        }
        let message = format!("`{}` cannot be {what}", word.value);
        let hint = "choose a name of letters, digits and `_` that neither WGSL nor generated code has";
        self.stop(codes::ROW, &word.origin, message, hint)
    }

    pub(super) fn sign(&mut self, line: &mut Line<'_>, sign: char, shape: &str) -> Read<()> {
        if line.sign(sign) { Ok(()) } else { self.unexpected(line, &format!("`{sign}`"), shape) }
    }

    pub(super) fn number(&mut self, line: &mut Line<'_>) -> Read<Spanned<u32>> {
        let word = self.word(line, "a number", "digits only, such as `8`")?;
        let Ok(number) = word.value.parse() else {
            let message = format!("`{}` is no whole number of 32 bits", word.value);
            return self.stop(codes::ROW, &word.origin, message, "write digits only, such as `8`");
        };
        Ok(Spanned::new(number, word.origin))
    }

    pub(super) fn facts(&mut self, line: &mut Line<'_>) -> Read<Vec<Fact>> {
        let mut facts = vec![self.fact(line)?];
        while line.sign(',') {
            facts.push(self.fact(line)?);
        }
        Ok(facts)
    }

    /// Facts that other rows offer, and capabilities that targets do, in one list.
    pub(super) fn requirements(&mut self, line: &mut Line<'_>) -> Read<(Vec<Fact>, Vec<Capability>)> {
        let (mut facts, mut capabilities) = (Vec::new(), Vec::new());
        loop {
            let word = self.word(line, "a fact or a capability", "`critical`, `fragment-atomics`")?;
            match Capability::ALL.iter().find(|capability| capability.word() == word.value) {
                Some(capability) => capabilities.push(*capability),
                None => facts.push(self.fact_of(&word, Capability::ALL)?),
            }
            if !line.sign(',') {
                return Ok((facts, capabilities));
            }
        }
    }

    pub(super) fn fact(&mut self, line: &mut Line<'_>) -> Read<Fact> {
        let word = self.word(line, "a fact", "`keeps-best`, `keeps-all`, `critical`")?;
        self.fact_of(&word, &[])
    }

    /// A formula over what the description gives.
    pub(super) fn condition(&mut self, line: &mut Line<'_>) -> Read<Formula> {
        let text = line.until(&[]);
        let symbols: Vec<&str> = Given::symbols().map(|symbol| symbol.name).collect();
        self.formula(&text, &symbols)?;
        Ok(text.value.into())
    }

    /// The fact of a word; where there is none, the hint knows capabilities that could stand there too.
    fn fact_of(&mut self, word: &Spanned<String>, capabilities: &[Capability]) -> Read<Fact> {
        if let Some(fact) = Fact::ALL.iter().find(|fact| fact.word() == word.value) {
            return Ok(*fact);
        }
        if Capability::ALL.iter().any(|capability| capability.word() == word.value) {
            let message = format!("`{}` is a capability, which targets offer and rows require", word.value);
            let hint = format!("leave it out here, and write `//: requires {}` where the row needs it", word.value);
            return self.stop(codes::UNKNOWN_FACT, &word.origin, message, hint);
        }
        let facts = Fact::ALL.iter().map(|fact| fact.word());
        let known: Vec<String> = facts.chain(capabilities.iter().map(|capability| capability.word())).collect();
        let message = format!("there is no fact `{}`", word.value);
        self.stop(codes::UNKNOWN_FACT, &word.origin, message, near::hint(&word.value, &known))
    }

    /// What one name of a hazard permits.
    pub(super) fn permits(&mut self, word: &Spanned<String>) -> Read<Permits> {
        if let Some(Shorthand::Permits(permits)) = Shorthand::of(&word.value) {
            return Ok(permits);
        }
        let known = Shorthand::ALL.into_iter().filter(|(_, one)| matches!(one, Shorthand::Permits(_)));
        let known: Vec<&str> = known.map(|(name, _)| name).collect();
        let message = format!("a hazard cannot permit `{}`", word.value);
        self.stop(codes::ROW, &word.origin, message, near::hint(&word.value, &known))
    }

    /// The value of a word in a table.
    pub(super) fn one_of<T: Copy>(&mut self, word: &Spanned<String>, table: &[(&str, T)], what: &str) -> Read<T> {
        if let Some((_, value)) = table.iter().find(|(name, _)| *name == word.value) {
            return Ok(*value);
        }
        let known: Vec<&str> = table.iter().map(|(name, _)| *name).collect();
        self.stop(codes::ROW, &word.origin, format!("`{}` is {what}", word.value), near::hint(&word.value, &known))
    }

    /// Reports a formula that cannot be read, that depends on what it may not, or that has no value whatever that is.
    pub(super) fn formula(&mut self, formula: &Spanned<String>, symbols: &[impl AsRef<str>]) -> Read<()> {
        let symbols: Vec<&str> = symbols.iter().map(AsRef::as_ref).collect();
        let Err(error) = readable(&Formula::from(formula.value.clone()), &symbols) else { return Ok(()) };
        let known = || {
            let symbols = symbols.join(", ");
            format!("the formula may use {symbols}, {OPERATORS}, min, max, ceil_div, pow2 and log2_ceil")
        };
        let (problem, hint) = match &error {
            FormulaError::Unbound(symbol) => (format!("`{symbol}` is no name that a formula may use here"), known()),
            FormulaError::Malformed { text, .. } => (format!("`{text}` is no formula"), known()),
            other => (other.to_string(), other.hint().to_owned()),
        };
        self.stop(codes::ROW, &formula.origin, problem, hint)
    }

    /// Keeps the place of a name or a formula.
    pub(super) fn stands(&mut self, what: Written, text: &Spanned<String>) {
        let Origin { line, column, length, .. } = text.origin;
        self.places.push(Place { what, text: text.value.clone().into(), line, column, length });
    }

    pub(super) fn unexpected<T>(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<T> {
        let message = format!("{what} belongs here, not {}", line.describe());
        let origin = line.here();
        self.stop(codes::ROW, &origin, message, format!("write {shape}"))
    }

    pub(super) fn stop<T>(&mut self, code: Code, at: &Origin, message: String, hint: impl Into<String>) -> Read<T> {
        self.fault(code, at, message, hint);
        Err(Stop)
    }

    pub(super) fn fault(&mut self, code: Code, at: &Origin, message: String, hint: impl Into<String>) {
        self.faults.push(Diagnostic::new(code, at, message, hint));
    }
}

/// Whether a formula can be read, is over these symbols, and has a value for some of theirs.
fn readable(formula: &Formula, symbols: &[&str]) -> Result<(), FormulaError> {
    let expression = formula.read()?;
    if let Some(symbol) = expression.symbols().into_iter().find(|symbol| !symbols.contains(symbol)) {
        return Err(FormulaError::Unbound(symbol.to_owned()));
    }
    expression.folded(&|_| None)?.polynomial(&|_| None)?;
    Ok(())
}
