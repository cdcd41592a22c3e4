//! Formats diagnostics for people, with the source line, the underlined span and the suggested fix, and for programs as JSON.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, Severity as Level};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::{self, Config};
use fragbuf_model::{Diagnostic, Diagnostics, Severity, SourceSpan};
use serde_json::{Value, json};

mod style;

/// Formats `diagnostics`; `sources` has the sources by file name. A span in an unknown source is printed without its line.
pub fn render(diagnostics: &Diagnostics, sources: &[(String, String)]) -> String {
    render_with(diagnostics, sources, &mut |files, report| {
        term::emit_into_string(&Config::default(), files, report).ok()
    })
}

/// Formats diagnostics as [`render`] does, with the escape sequences of a terminal for colours.
pub fn render_colored(diagnostics: &Diagnostics, sources: &[(String, String)]) -> String {
    render_with(diagnostics, sources, &mut |files, report| {
        let mut colored = style::Colored::default();
        term::emit_to_write_style(&mut colored, &Config::default(), files, report).ok()?;
        colored.text()
    })
}

/// Returns a diagnostic as JSON: `severity`, `code`, `message`, `help`, `file`, `line`, `column`, `length` and `labels`.
pub fn json(diagnostic: &Diagnostic) -> Value {
    let place = |span: &SourceSpan| (span.file.to_string(), span.line, span.column, span.length);
    let (file, line, column, length) = place(&diagnostic.span);
    let labels = diagnostic.labels.iter().map(|label| {
        let (file, line, column, length) = place(&label.span);
        json!({ "file": file, "line": line, "column": column, "length": length, "text": label.text })
    });
    json!({
        "severity": diagnostic.severity().name(),
        "code": diagnostic.code.name,
        "message": diagnostic.message,
        "help": diagnostic.help,
        "file": file,
        "line": line,
        "column": column,
        "length": length,
        "labels": labels.collect::<Vec<_>>(),
    })
}

type Files<'a> = SimpleFiles<&'a str, &'a str>;

fn render_with<'a>(
    diagnostics: &Diagnostics,
    sources: &'a [(String, String)],
    emit: &mut dyn FnMut(&Files<'a>, &Report<usize>) -> Option<String>,
) -> String {
    let mut files = SimpleFiles::new();
    let ids: Vec<usize> = sources.iter().map(|(name, text)| files.add(name.as_str(), text.as_str())).collect();
    let mut out = String::new();
    for diagnostic in diagnostics {
        let find = |span: &SourceSpan| {
            let index = sources.iter().position(|(name, _)| **name == *span.file)?;
            Some((ids[index], range(&sources[index].1, span)?))
        };
        let level = match diagnostic.severity() {
            Severity::Error => Level::Error,
            Severity::Warning => Level::Warning,
        };
        let mut report = Report::new(level).with_code(diagnostic.code.name).with_message(&diagnostic.message);
        report.notes.push(format!("help: {}", diagnostic.help));
        match find(&diagnostic.span) {
            Some((id, range)) => report.labels.push(Label::primary(id, range)),
            None => report.notes.insert(0, format!("at {}", diagnostic.span)),
        }
        for label in &diagnostic.labels {
            match find(&label.span) {
                Some((id, range)) => report.labels.push(Label::secondary(id, range).with_message(&label.text)),
                None => report.notes.push(format!("{}: {}", label.span, label.text)),
            }
        }
        match emit(&files, &report) {
            Some(text) => out.push_str(&text),
            None => out.push_str(&format!("{diagnostic}\n")),
        }
    }
    out
}

/// Returns the bytes that a span covers in its source.
fn range(text: &str, span: &SourceSpan) -> Option<std::ops::Range<usize>> {
    let line_start: usize = text.split_inclusive('\n').take(span.line.checked_sub(1)? as usize).map(str::len).sum();
    let line = text.get(line_start..)?.split('\n').next()?;
    let byte = |column: usize| line.char_indices().nth(column).map_or(line.len(), |(at, _)| at);
    let first = span.column.checked_sub(1)? as usize;
    Some(line_start + byte(first)..line_start + byte(first + span.length as usize))
}
