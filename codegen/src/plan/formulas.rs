//! The formulas of rows under one description: symbols with their values, and what is wrong with a formula that has none.
//!
//! In: a variant, a selection. Out: the table of symbols and the generated constants, or diagnostics at the lines of the files
//! that say so.

use fragbuf_model::{Code, Diagnostic, Diagnostics, Origin, Selected, Selection, Variant, codes};
use fragbuf_templates::vocabulary::{Formula, Parameter, Row};

use super::bucket;
use crate::symbols::Misdefined;
use crate::{Layout, SymbolTable};

/// The symbols of a plan: numbers of generation time, what rows define, the parameters of the rows. Also: the generated
/// constants, which are what every program may name, then the parameters.
pub(super) fn symbols(
    variant: &Variant,
    selection: &Selection,
    layout: &Layout,
) -> Result<(SymbolTable, Vec<(String, u32)>), Diagnostics> {
    let given = variant.given(selection);
    let capacity = u64::from(bucket(variant.keep));
    let number = |name: &str| if name == "capacity" { Some(capacity) } else { given.value(name) };
    let rows = || selection.rows.iter().map(|selected| &*selected.row);
    let defined: Vec<(&str, &Formula)> =
        rows().flat_map(|row| &row.defines).map(|defined| (&*defined.symbol, &defined.value)).collect();
    let mut table = SymbolTable::new(&number, &defined).map_err(|fault| misdefined(&fault, variant, selection))?;
    let mut constants =
        vec![("CAPACITY".to_owned(), bucket(variant.keep)), ("BESIDE_WORDS".to_owned(), layout.beside_words())];
    let mut faults = Diagnostics::new();
    for selected in &selection.rows {
        for parameter in &selected.row.parameters {
            match constant(selected, parameter, &mut table, variant) {
                Ok(value) => constants.push((parameter.constant.to_string(), value)),
                Err(fault) => faults.push(fault),
            }
        }
    }
    faults.gate((table, constants))
}

fn misdefined(fault: &Misdefined, variant: &Variant, selection: &Selection) -> Diagnostics {
    let mut rows = selection.rows.iter().map(|selected| &*selected.row);
    let is_its = |row: &&Row| {
        let mut defines = row.defines.iter();
        defines.any(|defined| defined.symbol == fault.symbol && defined.value == fault.formula)
    };
    let at = Place { row: rows.rfind(is_its), variant };
    at.fault(&fault.formula.0, fault.to_string(), fault.hint().to_owned()).into()
}

/// Adds a parameter to the symbols: what the description sets, else its default.
fn constant(
    selected: &Selected,
    parameter: &Parameter,
    table: &mut SymbolTable,
    variant: &Variant,
) -> Result<u32, Diagnostic> {
    let at = Place { row: Some(&selected.row), variant };
    let set = selected.options.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| *value);
    let value = set.map_or_else(|| default(selected, parameter, table, at), Ok)?;
    table.add(&parameter.constant, &parameter.summary, parameter.range, value).map_err(|_| {
        let message = format!("`{}` means something else in formulas already", parameter.constant);
        at.fault(&parameter.constant, message, "choose another name for the constant".to_owned())
    })?;
    Ok(value)
}

/// The default of a parameter, which must be a value that a description could set too.
fn default(selected: &Selected, parameter: &Parameter, table: &SymbolTable, at: Place<'_>) -> Result<u32, Diagnostic> {
    let text = &parameter.default;
    let value = table.compile(text).and_then(|default| table.evaluate(&default, &|_| None));
    let value = value.map_err(|error| at.fault(&text.0, error.to_string(), error.hint().to_owned()))?;
    let (least, greatest) = parameter.range;
    let word = u32::try_from(value).ok().filter(|value| (least..=greatest).contains(value));
    word.ok_or_else(|| {
        let (name, axis) = (&parameter.name, &selected.row.axis);
        let message = format!("the default of `{name}` is {value} here, not from {least} to {greatest}");
        let hint = format!("set it in the description, `{axis}: … {{ {name}: {least} }}`, or write another default");
        Diagnostic { code: at.code_or(&text.0, codes::BAD_OPTION), ..at.fault(&text.0, message, hint) }
    })
}

/// Where messages about a row's formulas point: into the user's file, where the row is one.
#[derive(Clone, Copy)]
struct Place<'a> {
    row: Option<&'a Row>,
    variant: &'a Variant,
}

impl Place<'_> {
    /// The place of a name or formula in the user's file.
    fn origin(self, text: &str) -> Option<Origin> {
        let row = self.row?;
        let file = row.template.as_ref()?.own.as_deref()?;
        let written = row.places.iter().find(|written| written.text == text)?;
        Some(Origin::new(file, written.line, written.column).with_length(written.length))
    }

    fn code_or(self, text: &str, other: Code) -> Code {
        if self.origin(text).is_some() { codes::ROW } else { other }
    }

    /// What is wrong with a name or formula. Rows that no file says are a program's, or fragbuf's own.
    fn fault(self, text: &str, message: String, hint: String) -> Diagnostic {
        if let Some(origin) = self.origin(text) {
            return Diagnostic::new(codes::ROW, &origin, message, hint);
        }
        let row = self.row.map(|row| format!("`{}: {}`: ", row.axis, row.key)).unwrap_or_default();
        Diagnostic::new(codes::INTERNAL, &self.variant.name.origin, format!("{row}{message}"), hint)
    }
}
