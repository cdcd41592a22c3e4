//! Evaluates the formulas of rows for one description, and reports formulas that have no value.
//!
//! Input: a variant and a selection. Output: the table of symbols and the generated constants, or diagnostics with the spans of the
//! formulas in user files.

use fragbuf_model::{Code, Diagnostic, Diagnostics, SelectedRow, Selection, SourceSpan, Variant, codes};
use fragbuf_templates::vocabulary::{
    Definition, Formula, FormulaError, Parameter, ParameterType, Row, RowItem, Step, Text, Words,
};

use super::notation::normal_form;
use super::resource::size;
use crate::definitions::DefinitionError;
use crate::{Layout, SymbolTable};

/// Returns the symbols of a plan: numbers that are known at generation, definitions of rows, parameters of rows. Also returns the
/// generated constants: those of every program, then the parameters.
pub(super) fn symbols(
    variant: &Variant,
    selection: &Selection,
    layout: &Layout,
) -> Result<(SymbolTable, Vec<(String, u32)>), Diagnostics> {
    let values = variant.description_values(selection);
    let capacity = u64::from(bucket(variant.keep));
    let number = |name: &str| if name == "capacity" { Some(capacity) } else { values.value(name) };
    let rows = || selection.rows.iter().map(|selected| &*selected.row);
    let definitions: Vec<(&str, &Formula)> =
        rows().flat_map(|row| &row.defines).map(|definition| (&*definition.symbol, &definition.value)).collect();
    let mut table =
        SymbolTable::new(&number, &definitions).map_err(|error| definition_error(&error, variant, selection))?;
    let mut constants =
        vec![("CAPACITY".to_owned(), bucket(variant.keep)), ("VALUE_WORDS".to_owned(), layout.value_words())];
    let mut diagnostics = Diagnostics::new();
    for selected in &selection.rows {
        for parameter in &selected.row.parameters {
            match add_parameter(selected, parameter, &mut table, variant) {
                Ok(value) => constants.push((parameter.constant.to_string(), value)),
                Err(errors) => diagnostics.extend(errors),
            }
        }
    }
    for row in rows() {
        for constant in &row.constants {
            match add_constant(row, constant, &mut table, variant) {
                Ok(value) => constants.push((constant.symbol.to_string(), value)),
                Err(errors) => diagnostics.extend(errors),
            }
        }
    }
    diagnostics.into_result((table, constants))
}

/// Adds a constant that a row generates for other rows to the symbols. Returns its value.
fn add_constant(
    row: &Row,
    constant: &Definition,
    table: &mut SymbolTable,
    variant: &Variant,
) -> Result<u32, Diagnostics> {
    let context = RowContext { row: Some(row), variant };
    let text = &constant.value;
    let value = table.compile(text).and_then(|value| table.evaluate(&value, &|_| None));
    let invalid = |message: String, help: &str| -> Diagnostics {
        context.diagnostic(RowItem::Definition, &text.0, message, help.to_owned()).into()
    };
    let value = value.map_err(|error| invalid(error.to_string(), error.help()))?;
    let name = &constant.symbol;
    let value = u32::try_from(value)
        .map_err(|_| invalid(format!("`{name}` is {value} here, which is not a word"), "choose lesser options"))?;
    table
        .add(name, &Text::Borrowed("a constant that a row generates"), (0, u32::MAX), value)
        .map_err(|_| invalid(format!("`{name}` already has another meaning in formulas"), "choose another name"))?;
    Ok(value)
}

fn definition_error(error: &DefinitionError, variant: &Variant, selection: &Selection) -> Diagnostics {
    let mut rows = selection.rows.iter().map(|selected| &*selected.row);
    let is_defined_by = |row: &&Row| {
        let mut definitions = row.defines.iter();
        definitions.any(|definition| definition.symbol == error.symbol && definition.value == error.formula)
    };
    let context = RowContext { row: rows.rfind(is_defined_by), variant };
    context.diagnostic(RowItem::Definition, &error.formula.0, error.to_string(), error.help().to_owned()).into()
}

/// Returns the capacity for k kept fragments: k can change up to it without new code. The default for an A-buffer is 64 layers; a
/// description can set `sort.layers`.
pub fn bucket(keep: Option<u32>) -> u32 {
    keep.map_or(64, u32::next_power_of_two)
}

/// Adds a parameter to the symbols. Returns its value: that of the description, or else its default.
fn add_parameter(
    selected: &SelectedRow,
    parameter: &Parameter,
    table: &mut SymbolTable,
    variant: &Variant,
) -> Result<u32, Diagnostics> {
    let context = RowContext { row: Some(&selected.row), variant };
    let set = selected.options.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| *value);
    let value = set.map_or_else(|| default(selected, parameter, table, variant, context), Ok)?;
    table.add(&parameter.constant, &parameter.summary, parameter.range, value).map_err(|_| {
        let message = format!("`{}` already has another meaning in formulas", parameter.constant);
        let help = "choose another name for the constant".to_owned();
        context.diagnostic(RowItem::Constant, &parameter.constant, message, help)
    })?;
    Ok(value)
}

/// Returns the default of a parameter. It must meet the restrictions of the parameter.
fn default(
    selected: &SelectedRow,
    parameter: &Parameter,
    table: &SymbolTable,
    variant: &Variant,
    context: RowContext<'_>,
) -> Result<u32, Diagnostics> {
    let text = &parameter.default;
    let value = table.compile(text).and_then(|default| table.evaluate(&default, &|_| None));
    let value = value
        .map_err(|error| context.diagnostic(RowItem::Default, &text.0, error.to_string(), error.help().to_owned()))?;
    let problem = match invalid_default(value, selected, parameter, variant) {
        Ok(value) => return Ok(value),
        Err(problem) => problem,
    };
    let (name, axis) = (&parameter.name, &selected.row.axis);
    let message = format!("the default of `{name}` is {value} here; it must be {problem}");
    let help = match valid_value(selected, parameter, variant) {
        Some(valid) => format!("set it in the description, `{axis}: … {{ {name}: {valid} }}`, or change the default"),
        None => format!("no value of `{name}` is valid here: change its range or its minimum, or keep fewer fragments"),
    };
    Err(Diagnostic {
        code: context.code_or(RowItem::Default, &text.0, codes::INVALID_OPTION),
        ..context.diagnostic(RowItem::Default, &text.0, message, help)
    }
    .into())
}

/// Returns the value of a default, or what it must be.
fn invalid_default(
    value: u64,
    selected: &SelectedRow,
    parameter: &Parameter,
    variant: &Variant,
) -> Result<u32, String> {
    let (least, greatest) = parameter.range;
    let Some(number) = u32::try_from(value).ok().filter(|value| (least..=greatest).contains(value)) else {
        return Err(format!("from {least} to {greatest}"));
    };
    let attributes = variant.attributes.len() as u64;
    match parameter.kind {
        ParameterType::PowerOfTwo if !number.is_power_of_two() => return Err("a power of two".to_owned()),
        ParameterType::Attribute if value >= attributes => {
            return Err(format!("the index of one of {attributes} attributes"));
        }
        _ => {}
    }
    match minimum(selected, parameter, variant) {
        Some(minimum) if value < minimum => Err(format!("at least {minimum} for k up to {}", bucket(variant.keep))),
        _ => Ok(number),
    }
}

/// Returns the least valid value of a parameter, if the row restricts it further than to its range.
fn minimum(selected: &SelectedRow, parameter: &Parameter, variant: &Variant) -> Option<u64> {
    let k = u64::from(bucket(variant.keep));
    let minimums = selected.row.least.iter().filter(|(option, _)| *option == parameter.name);
    minimums.filter_map(|(_, least)| least.evaluate(&|symbol| (symbol == "k").then_some(k)).ok()).max()
}

/// Returns the least value that meets the restrictions of a parameter, as a description writes it.
fn valid_value(selected: &SelectedRow, parameter: &Parameter, variant: &Variant) -> Option<String> {
    let (least, greatest) = parameter.range;
    let from = u64::from(least).max(minimum(selected, parameter, variant).unwrap_or(0));
    let from = u32::try_from(from).ok()?;
    let number = match parameter.kind {
        ParameterType::PowerOfTwo => from.checked_next_power_of_two()?,
        ParameterType::Attribute | ParameterType::Number => from,
    };
    match parameter.kind {
        _ if number > greatest => None,
        ParameterType::Attribute => Some(variant.attributes.get(number as usize)?.name.value.clone()),
        ParameterType::Number | ParameterType::PowerOfTwo => Some(number.to_string()),
    }
}

/// Checks that every shader and device can compute the formulas of user files for sizes and reads. Other errors in a plan are not
/// errors of the user.
pub(super) fn check_user_formulas(
    variant: &Variant,
    selection: &Selection,
    symbols: &SymbolTable,
) -> Result<(), Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    for row in selection.rows.iter().map(|selected| &*selected.row) {
        let context = RowContext { row: Some(row), variant };
        let mut report = |item, text: &str, result: Result<(), FormulaError>| {
            if let Err(error) = result {
                diagnostics.push(context.diagnostic(item, text, error.to_string(), error.help().to_owned()));
            }
        };
        for resource in &row.resources {
            let lengths = resource.extents.iter().map(|extent| &extent.length);
            let is_valid = lengths.clone().all(|length| symbols.length(length).is_ok());
            lengths.for_each(|length| report(RowItem::Length, &length.0, symbols.length(length).map(drop)));
            if is_valid {
                report(RowItem::Resource, &resource.name, size(resource).and_then(|size| check_size(&size, symbols)));
            }
        }
        for formula in row.steps.iter().flat_map(reads) {
            report(RowItem::Read, &formula.0, symbols.compile(formula).map(drop));
        }
    }
    diagnostics.into_result(())
}

/// Checks that the size of a resource has a value and a normal form, which plans print.
fn check_size(size: &Formula, symbols: &SymbolTable) -> Result<(), FormulaError> {
    symbols.compile(size)?;
    normal_form(size, symbols).map(drop)
}

/// Returns the formulas of the words that a host step reads.
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

/// The context of diagnostics about a row. They point into the user file, if the row comes from one.
#[derive(Clone, Copy)]
struct RowContext<'a> {
    row: Option<&'a Row>,
    variant: &'a Variant,
}

impl RowContext<'_> {
    /// Returns the span of a name or formula in the user file.
    fn span(self, item: RowItem, text: &str) -> Option<SourceSpan> {
        let row = self.row?;
        let file = row.template.as_ref()?.user_file.as_deref()?;
        let span = row.item_spans.iter().find(|span| (span.item, &*span.text) == (item, text))?;
        Some(SourceSpan::new(file, span.line, span.column).with_length(span.length))
    }

    /// Returns `invalid-row` for an item of a user file, or else `other`.
    fn code_or(self, item: RowItem, text: &str, other: Code) -> Code {
        if self.span(item, text).is_some() { codes::INVALID_ROW } else { other }
    }

    /// Returns a diagnostic for a name or formula. Rows without a user file come from a program or from fragbuf.
    fn diagnostic(self, item: RowItem, text: &str, message: String, help: String) -> Diagnostic {
        if let Some(span) = self.span(item, text) {
            return Diagnostic::new(codes::INVALID_ROW, &span, message, help);
        }
        let row = self.row.map(|row| format!("`{}: {}`: ", row.axis, row.key)).unwrap_or_default();
        Diagnostic::new(codes::INTERNAL, &self.variant.name.span, format!("{row}{message}"), help)
    }
}
