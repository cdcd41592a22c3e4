//! Answers about a document as JSON of the protocol.
//!
//! Input: results of the analysis. Output: JSON. Positions are in UTF-16 code units, which every client has.

use std::collections::BTreeMap;

use fragbuf::Severity;
use fragbuf::analysis::{Completion, CompletionKind, Definition, Document, Edit, Found, Symbol, SymbolKind, TextSpan};
use fragbuf_syntax::NameKind;
use serde_json::{Value, json};

use super::parameters::Range;
use super::uri;

/// Returns the diagnostics of a document by the URIs of their files. The document is always one of them.
pub(super) fn diagnostics(document: &Document<'_>, uri: &str) -> BTreeMap<String, Vec<Value>> {
    let mut found = BTreeMap::from([(uri.to_owned(), Vec::new())]);
    for diagnostic in document.diagnostics_without_fixes() {
        let file = diagnostic.file.as_deref().map_or(uri.to_owned(), uri::of_path);
        found.entry(file).or_default().push(self::diagnostic(&diagnostic, uri));
    }
    found
}

fn diagnostic(found: &Found, uri: &str) -> Value {
    let severity = match found.severity {
        Severity::Error => 1,
        Severity::Warning => 2,
    };
    let labels = found.labels.iter().map(|label| {
        let file = label.file.as_deref().map_or(uri.to_owned(), uri::of_path);
        json!({ "location": { "uri": file, "range": range(&label.span) }, "message": label.text })
    });
    json!({
        "range": range(&found.span),
        "severity": severity,
        "code": found.code,
        "source": "fragbuf",
        "message": format!("{}\nhelp: {}", found.message, found.help),
        "relatedInformation": labels.collect::<Vec<_>>(),
    })
}

/// Returns the fixes of the diagnostics that touch a range.
pub(super) fn actions(document: &Document<'_>, uri: &str, asked: Range) -> Value {
    let touches = |found: &&Found| {
        found.file.is_none()
            && found.span.start <= asked.end.max(asked.start)
            && asked.start.min(asked.end) <= found.span.end
    };
    let diagnostics = document.diagnostics();
    let actions = diagnostics.iter().filter(touches).flat_map(|found| {
        found.fixes.iter().enumerate().map(move |(index, fix)| {
            let edits: Vec<Value> = fix.edits.iter().map(edit).collect();
            json!({
                "title": fix.title,
                "kind": "quickfix",
                "diagnostics": [diagnostic(found, uri)],
                "isPreferred": index == 0,
                "edit": { "changes": { uri: edits } },
            })
        })
    });
    actions.collect()
}

/// Returns what is shown over a name.
pub(super) fn hover(document: &Document<'_>, offset: usize) -> Value {
    document.hover(offset).map_or(
        Value::Null,
        |hover| json!({ "contents": { "kind": "markdown", "value": hover.markdown }, "range": range(&hover.span) }),
    )
}

/// Returns what can be written at an offset. An illegal value is struck out, and behind the others.
pub(super) fn completion(document: &Document<'_>, offset: usize) -> Value {
    let items: Vec<Value> = document.completion(offset).iter().enumerate().map(item).collect();
    json!({ "isIncomplete": false, "items": items })
}

fn item((index, completion): (usize, &Completion)) -> Value {
    let kind = match completion.kind {
        CompletionKind::Keyword => 14,
        CompletionKind::Technique => 9,
        CompletionKind::Axis => 10,
        CompletionKind::Value => 20,
        CompletionKind::Option => 5,
        CompletionKind::Type | CompletionKind::Name(NameKind::Type) => 25,
        CompletionKind::Name(NameKind::Variable) => 6,
        CompletionKind::Name(NameKind::Attribute | NameKind::Uniform | NameKind::Component) => 5,
        CompletionKind::Name(NameKind::Function) => 3,
        CompletionKind::Name(NameKind::Method) => 2,
        CompletionKind::Name(NameKind::Constant) => 21,
    };
    let mut item = json!({
        "label": completion.label,
        "kind": kind,
        "detail": completion.detail,
        "documentation": { "kind": "markdown", "value": completion.documentation },
        "sortText": format!("{}{index:04}", u8::from(completion.illegal.is_some())),
        "filterText": completion.label,
        "textEdit": edit(&completion.edit),
    });
    if let Some(reason) = &completion.illegal {
        item["detail"] = json!(format!("illegal here: {reason}"));
        item["tags"] = json!([1]);
        item["deprecated"] = json!(true);
        let about = format!("Illegal here: {reason}\n\n{}", completion.documentation);
        item["documentation"] = json!({ "kind": "markdown", "value": about });
    }
    item
}

/// Returns the place that declares a name.
pub(super) fn definition(document: &Document<'_>, uri: &str, offset: usize) -> Value {
    let start = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } });
    match document.definition(offset) {
        Some(Definition::Template { path, .. }) => json!({ "uri": uri::of_template(&path), "range": start }),
        Some(Definition::File { path }) => json!({ "uri": uri::of_path(&path), "range": start }),
        Some(Definition::Text(span)) => json!({ "uri": uri, "range": range(&span) }),
        None => Value::Null,
    }
}

/// Returns the outline.
pub(super) fn symbols(document: &Document<'_>) -> Value {
    document.outline().iter().map(symbol).collect()
}

fn symbol(symbol: &Symbol) -> Value {
    let kind = match symbol.kind {
        SymbolKind::Buffer => 23,
        SymbolKind::Attribute | SymbolKind::Uniform => 8,
        SymbolKind::Choice => 7,
        SymbolKind::Function => 12,
    };
    json!({
        "name": symbol.name,
        "detail": symbol.detail,
        "kind": kind,
        "range": range(&symbol.span),
        "selectionRange": range(&symbol.name_span),
        "children": symbol.children.iter().map(self::symbol).collect::<Vec<_>>(),
    })
}

fn edit(edit: &Edit) -> Value {
    json!({ "range": range(&edit.span), "newText": edit.text })
}

fn range(span: &TextSpan) -> Value {
    let position =
        |position: fragbuf::analysis::Position| json!({ "line": position.line, "character": position.character });
    json!({ "start": position(span.start), "end": position(span.end) })
}
