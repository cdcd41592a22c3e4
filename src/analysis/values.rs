//! The values of an axis, each with the reason why it is illegal in a description.
//!
//! Input: a description without the choice. Output: rows with reasons, which the rules give: every value is tried.

use fragbuf_model::{Alternative, Choice, Diagnostic, Draft, SourceSpan, Spanned, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Row;

use super::fixes::Trials;
use super::{Document, Edit, TextSpan};

/// An axis, with its values in a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisValues {
    /// The key of the axis.
    pub axis: String,
    /// What is chosen.
    pub summary: String,
    /// The values that are in effect, the first that a target supports: of the text, of the technique or by default.
    pub current: Vec<String>,
    /// The choice in the text; `None`: the text does not choose.
    pub span: Option<TextSpan>,
    /// All values.
    pub values: Vec<AxisValue>,
}

/// A value of an axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisValue {
    /// The key.
    pub key: String,
    /// What it does, in a line.
    pub summary: String,
    /// The error that the description would have, in the words of the compiler. `None`: it is legal.
    pub illegal: Option<String>,
    /// The edits that choose it.
    pub edits: Vec<Edit>,
}

impl Document<'_> {
    /// Returns every axis with its values. Each value is tried, which takes longer than the other answers. A text without a buffer has
    /// none.
    pub fn axes(&self) -> Vec<AxisValues> {
        if self.is_too_long() {
            return Vec::new();
        }
        let compiled = self.compile();
        let Some(draft) = &compiled.draft else { return Vec::new() };
        let (trials, lines) = (Trials::new(self, &compiled), self.lines());
        let axes = compiled.registry.axes().iter().filter(|axis| axis.chosen);
        let axes = axes.map(|axis| {
            let choice = draft.choices.iter().find(|choice| choice.axis.value == axis.key);
            let in_effect = compiled.variant.iter().flat_map(|variant| &variant.choices);
            let in_effect = in_effect.filter(|chosen| chosen.axis == axis.key).flat_map(|chosen| &chosen.alternatives);
            let value = |(row, error): (&Row, Option<Diagnostic>)| AxisValue {
                key: row.key.clone(),
                summary: row.summary.to_string(),
                illegal: error.as_ref().map(reason),
                edits: trials.choose(axis.key, &row.key),
            };
            AxisValues {
                axis: axis.key.to_owned(),
                summary: axis.summary.to_owned(),
                current: in_effect.map(|selected| selected.row.key.clone()).collect(),
                span: choice.map(|choice| lines.source_span(&choice.axis.span)),
                values: values(draft, axis.key, &compiled.registry).into_iter().map(value).collect(),
            }
        });
        axes.collect()
    }
}

/// Returns why a value is illegal, and what to do.
pub(super) fn reason(error: &Diagnostic) -> String {
    format!("{}; {}", error.message, error.help)
}

/// Returns the values of an axis with the first error that each has and others do not.
pub(super) fn values<'r>(draft: &Draft, axis: &str, registry: &'r Registry) -> Vec<(&'r Row, Option<Diagnostic>)> {
    let rows: Vec<&Row> =
        registry.rows().iter().filter(|row| row.axis == axis && !Registry::is_of_closures(row)).collect();
    let errors: Vec<Vec<Diagnostic>> = rows.iter().map(|row| errors(draft, axis, &row.key, registry)).collect();
    // What is wrong for every value is no reason against one.
    let is_general = |error: &Diagnostic| {
        errors
            .iter()
            .all(|others| others.iter().any(|other| other.code == error.code && other.message == error.message))
    };
    let reason = |found: &Vec<Diagnostic>| found.iter().find(|error| !is_general(error)).cloned();
    rows.iter().zip(&errors).map(|(row, found)| (*row, reason(found))).collect()
}

fn errors(draft: &Draft, axis: &str, value: &str, registry: &Registry) -> Vec<Diagnostic> {
    let span = SourceSpan::new(draft.name.span.file.clone(), 1, 1);
    let value = Spanned::new(value.to_owned(), span.clone());
    let mut changed = draft.clone();
    let alternatives = vec![Alternative { value, options: Vec::new() }];
    changed.choose(Choice { axis: Spanned::new(axis.to_owned(), span), alternatives });
    match check(&changed, registry) {
        Ok(_) => Vec::new(),
        Err(errors) => errors.iter().cloned().collect(),
    }
}
