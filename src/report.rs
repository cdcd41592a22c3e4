//! Diagnostics as a person reads them: with the source line, the place under it and the way out below.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::{self, Config};
use fragbuf_model::{Diagnostics, Origin};

/// Draws `diagnostics`; `sources` are the texts by file name. A place in no known text is given without its line.
pub fn render(diagnostics: &Diagnostics, sources: &[(String, String)]) -> String {
    let mut files = SimpleFiles::new();
    let ids: Vec<usize> = sources.iter().map(|(name, text)| files.add(name.as_str(), text.as_str())).collect();
    let mut out = String::new();
    for diagnostic in diagnostics {
        let place = |origin: &Origin| {
            let index = sources.iter().position(|(name, _)| **name == *origin.file)?;
            Some((ids[index], range(&sources[index].1, origin)?))
        };
        let mut report = Report::error().with_code(diagnostic.code.name).with_message(&diagnostic.message);
        report.notes.push(format!("help: {}", diagnostic.hint));
        match place(&diagnostic.origin) {
            Some((id, range)) => report.labels.push(Label::primary(id, range)),
            None => report.notes.insert(0, format!("at {}", diagnostic.origin)),
        }
        for label in &diagnostic.labels {
            match place(&label.origin) {
                Some((id, range)) => report.labels.push(Label::secondary(id, range).with_message(&label.text)),
                None => report.notes.push(format!("{}: {}", label.origin, label.text)),
            }
        }
        match term::emit_into_string(&Config::default(), &files, &report) {
            Ok(text) => out.push_str(&text),
            Err(_) => out.push_str(&format!("{diagnostic}\n")),
        }
    }
    out
}

/// The bytes that a place covers in its text.
fn range(text: &str, origin: &Origin) -> Option<std::ops::Range<usize>> {
    let line_start: usize = text.split_inclusive('\n').take(origin.line.checked_sub(1)? as usize).map(str::len).sum();
    let line = text.get(line_start..)?.split('\n').next()?;
    let byte = |column: usize| line.char_indices().nth(column).map_or(line.len(), |(at, _)| at);
    let first = origin.column.checked_sub(1)? as usize;
    Some(line_start + byte(first)..line_start + byte(first + origin.length as usize))
}
