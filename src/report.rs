//! Formats diagnostics for people: the source line, the underlined span and the suggested fix.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::{self, Config};
use fragbuf_model::{Diagnostics, SourceSpan};

/// Formats `diagnostics`; `sources` has the sources by file name. A span in an unknown source is printed without its line.
pub fn render(diagnostics: &Diagnostics, sources: &[(String, String)]) -> String {
    let mut files = SimpleFiles::new();
    let ids: Vec<usize> = sources.iter().map(|(name, text)| files.add(name.as_str(), text.as_str())).collect();
    let mut out = String::new();
    for diagnostic in diagnostics {
        let find = |span: &SourceSpan| {
            let index = sources.iter().position(|(name, _)| **name == *span.file)?;
            Some((ids[index], range(&sources[index].1, span)?))
        };
        let mut report = Report::error().with_code(diagnostic.code.name).with_message(&diagnostic.message);
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
        match term::emit_into_string(&Config::default(), &files, &report) {
            Ok(text) => out.push_str(&text),
            Err(_) => out.push_str(&format!("{diagnostic}\n")),
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
