//! The formulas of rows under one description: symbols with their values, and what is wrong with a formula that has none.
//!
//! In: a variant, a selection. Out: the table of symbols and the generated constants, or diagnostics at the lines of the files
//! that say so.

use fragbuf_model::{Code, Diagnostic, Diagnostics, Origin, Selected, Selection, Variant, codes};
use fragbuf_templates::vocabulary::{Formula, FormulaError, Parameter, Row, Step, Words, Written};

use super::summary::normal_form;
use super::{bucket, size};
use crate::definitions::Misdefined;
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
                Err(fault) => faults.extend(fault),
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
    at.fault(Written::Definition, &fault.formula.0, fault.to_string(), fault.hint().to_owned())
}

/// Adds a parameter to the symbols: what the description sets, else its default.
fn constant(
    selected: &Selected,
    parameter: &Parameter,
    table: &mut SymbolTable,
    variant: &Variant,
) -> Result<u32, Diagnostics> {
    let at = Place { row: Some(&selected.row), variant };
    let set = selected.options.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| *value);
    let value = set.map_or_else(|| default(selected, parameter, table, at), Ok)?;
    table.add(&parameter.constant, &parameter.summary, parameter.range, value).map_err(|_| {
        let message = format!("`{}` means something else in formulas already", parameter.constant);
        at.fault(Written::Constant, &parameter.constant, message, "choose another name for the constant".to_owned())
    })?;
    Ok(value)
}

/// The default of a parameter, which must be a value that a description could set too.
fn default(selected: &Selected, parameter: &Parameter, table: &SymbolTable, at: Place<'_>) -> Result<u32, Diagnostics> {
    let text = &parameter.default;
    let value = table.compile(text).and_then(|default| table.evaluate(&default, &|_| None));
    let value =
        value.map_err(|error| at.fault(Written::Default, &text.0, error.to_string(), error.hint().to_owned()))?;
    let (least, greatest) = parameter.range;
    let word = u32::try_from(value).ok().filter(|value| (least..=greatest).contains(value));
    word.ok_or_else(|| {
        let (name, axis) = (&parameter.name, &selected.row.axis);
        let message = format!("the default of `{name}` is {value} here, not from {least} to {greatest}");
        let hint = format!("set it in the description, `{axis}: … {{ {name}: {least} }}`, or write another default");
        at.fault_or(codes::BAD_OPTION, Written::Default, &text.0, message, hint)
    })
}

/// Whether the formulas of users' files that memory and reads rest on can be computed by every shader and device: whatever
/// else is refused in a plan is not the user's own mistake.
pub(super) fn check(variant: &Variant, selection: &Selection, symbols: &SymbolTable) -> Result<(), Diagnostics> {
    let mut faults = Diagnostics::new();
    for row in selection.rows.iter().map(|selected| &*selected.row) {
        let at = Place { row: Some(row), variant };
        let mut report = |what, text: &str, result: Result<(), FormulaError>| {
            if let Err(error) = result {
                faults.extend(at.fault(what, text, error.to_string(), error.hint().to_owned()));
            }
        };
        for resource in &row.resources {
            let lengths = resource.extents.iter().map(|extent| &extent.length);
            let is_right = lengths.clone().all(|length| symbols.length(length).is_ok());
            lengths.for_each(|length| report(Written::Length, &length.0, symbols.length(length).map(drop)));
            if is_right {
                report(Written::Resource, &resource.name, size(resource).and_then(|size| sized(&size, symbols)));
            }
        }
        for formula in row.steps.iter().flat_map(reads) {
            report(Written::Read, &formula.0, symbols.compile(formula).map(drop));
        }
    }
    faults.gate(())
}

/// Whether the size of a resource has a value, and a form that a plan can print.
fn sized(size: &Formula, symbols: &SymbolTable) -> Result<(), FormulaError> {
    symbols.compile(size)?;
    normal_form(size, symbols).map(drop)
}

/// The formulas of the words that a host step reads.
fn reads(step: &Step) -> Vec<&Formula> {
    let Step::Host(host) = step else { return Vec::new() };
    let words = host.reads.iter().map(|read| &read.words);
    words
        .flat_map(|words| match words {
            Words::All => Vec::new(),
            Words::Some { first, count } => vec![first, count],
        })
        .collect()
}

/// Where messages about a row's formulas point: into the user's file, where the row is one.
#[derive(Clone, Copy)]
struct Place<'a> {
    row: Option<&'a Row>,
    variant: &'a Variant,
}

impl Place<'_> {
    /// The place of a name or formula in the user's file.
    fn origin(self, what: Written, text: &str) -> Option<Origin> {
        let row = self.row?;
        let file = row.template.as_ref()?.own.as_deref()?;
        let place = row.places.iter().find(|place| (place.what, &*place.text) == (what, text))?;
        Some(Origin::new(file, place.line, place.column).with_length(place.length))
    }

    /// What is wrong with a name or formula. Rows that no file says are a program's, or fragbuf's own.
    fn fault(self, what: Written, text: &str, message: String, hint: String) -> Diagnostics {
        self.fault_or(codes::INTERNAL, what, text, message, hint)
    }

    /// The same, where the row is no file's with this code at the description.
    fn fault_or(self, code: Code, what: Written, text: &str, message: String, hint: String) -> Diagnostics {
        if let Some(origin) = self.origin(what, text) {
            return Diagnostic::new(codes::ROW, &origin, message, hint).into();
        }
        let row = self.row.map(|row| format!("`{}: {}`: ", row.axis, row.key)).unwrap_or_default();
        Diagnostic::new(code, &self.variant.name.origin, format!("{row}{message}"), hint).into()
    }
}
