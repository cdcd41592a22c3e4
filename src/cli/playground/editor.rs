//! Answers what the editor of the page shows: diagnostics with their fixes, hovers, completions and the values of axes, all as the
//! library's analysis has them. Offsets are UTF-16 code units, as in JavaScript.

use fragbuf::analysis::{
    AxisValue, AxisValues, Completion, CompletionKind, Document, Edit, Fix, Found, Label, Lines, TextSpan,
};
use fragbuf::{Registry, Severity};
use serde::Deserialize;
use serde_json::{Value, json};

use super::description::Folder;
use super::problem::Problem;

/// A place in a description.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    text: String,
    offset: usize,
}

impl Place {
    /// Returns the meaning of what is there; null for nothing.
    pub(super) fn hover(&self, folder: &Folder) -> Result<Value, Problem> {
        let registry = Registry::builtin();
        let file = folder.file();
        let document = folder.document(&self.text, &file, &registry);
        let lines = document.lines();
        let found = document.hover(lines.of_utf16(self.offset));
        Ok(found.map_or(Value::Null, |hover| with_span(&lines, &hover.span, json!({ "markdown": hover.markdown }))))
    }

    /// Returns what can be written there; null for nothing.
    pub(super) fn complete(&self, folder: &Folder) -> Result<Value, Problem> {
        let registry = Registry::builtin();
        let file = folder.file();
        let document = folder.document(&self.text, &file, &registry);
        let lines = document.lines();
        let found = document.completion(lines.of_utf16(self.offset));
        let Some(first) = found.first() else { return Ok(Value::Null) };
        let items: Vec<Value> = found.iter().filter(|item| item.edit.span == first.edit.span).map(completion).collect();
        Ok(with_span(&lines, &first.edit.span, json!({ "items": items })))
    }
}

/// Returns the diagnostics of a document.
pub(super) fn diagnostics(document: &Document<'_>) -> Vec<Value> {
    let lines = document.lines();
    document.diagnostics().iter().map(|found| diagnostic(&lines, found)).collect()
}

/// Returns the axes of a document with the values that they can have, and why they cannot have the others.
pub(super) fn axes(document: &Document<'_>) -> Vec<Value> {
    let lines = document.lines();
    document.axes().iter().map(|axis| values(&lines, axis)).collect()
}

fn diagnostic(lines: &Lines<'_>, found: &Found) -> Value {
    let label = |label: &Label| with_span(lines, &label.span, json!({ "text": label.text, "file": label.file }));
    let fix = |fix: &Fix| json!({ "title": fix.title, "edits": edits(lines, &fix.edits) });
    let severity = match found.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let facts = json!({
        "severity": severity,
        "code": found.code,
        "meaning": found.meaning,
        "message": found.message,
        "help": found.help,
        "file": found.file,
        "line": found.span.start.line + 1,
        "column": found.span.start.character + 1,
        "labels": found.labels.iter().map(label).collect::<Vec<_>>(),
        "fixes": found.fixes.iter().map(fix).collect::<Vec<_>>(),
    });
    with_span(lines, &found.span, facts)
}

fn values(lines: &Lines<'_>, axis: &AxisValues) -> Value {
    let value = |value: &AxisValue| {
        json!({
            "key": value.key,
            "summary": value.summary,
            "current": axis.current.first() == Some(&value.key),
            "illegal": value.illegal,
            "edits": edits(lines, &value.edits),
        })
    };
    json!({
        "axis": axis.axis,
        "meaning": axis.summary,
        "value": axis.current.join(" else "),
        "from": axis.span.as_ref().map(|span| lines.utf16(span.bytes.start)),
        "to": axis.span.as_ref().map(|span| lines.utf16(span.bytes.end)),
        "values": axis.values.iter().map(value).collect::<Vec<_>>(),
    })
}

fn completion(item: &Completion) -> Value {
    json!({
        "label": item.label,
        "kind": kind(item.kind),
        "detail": item.detail,
        "documentation": item.documentation,
        "insert": item.edit.text,
        "illegal": item.illegal,
    })
}

fn edits(lines: &Lines<'_>, edits: &[Edit]) -> Vec<Value> {
    edits.iter().map(|edit| with_span(lines, &edit.span, json!({ "insert": edit.text }))).collect()
}

/// Adds a part of the text to a JSON object.
fn with_span(lines: &Lines<'_>, span: &TextSpan, mut object: Value) -> Value {
    object["from"] = lines.utf16(span.bytes.start).into();
    object["to"] = lines.utf16(span.bytes.end).into();
    object
}

/// Returns the word by which the editor of the page chooses an icon.
fn kind(kind: CompletionKind) -> &'static str {
    match kind {
        CompletionKind::Keyword => "keyword",
        CompletionKind::Technique => "class",
        CompletionKind::Axis => "property",
        CompletionKind::Value => "enum",
        CompletionKind::Option => "constant",
        CompletionKind::Type => "type",
        CompletionKind::Name(_) => "variable",
    }
}
