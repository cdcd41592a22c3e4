//! The diagnostics of a document, with their spans in the text and their fixes as edits.

use fragbuf_model::{Diagnostic, Severity, SourceSpan};

use super::{Compiled, Document, Lines, TextSpan, fixes};
use crate::source_file;

/// A diagnostic of a document. Code, message and help are those of the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The name of its code.
    pub code: &'static str,
    /// The meaning of the code in general.
    pub meaning: &'static str,
    /// Its severity.
    pub severity: Severity,
    /// The error.
    pub message: String,
    /// A fix, as an instruction.
    pub help: String,
    /// The user file that has the error, by its name in messages. `None`: the document.
    pub file: Option<String>,
    /// Its place in the document or the user file.
    pub span: TextSpan,
    /// Further places that explain it.
    pub labels: Vec<Label>,
    /// Changes of the document after which the diagnostic is gone. Each has been compiled.
    pub fixes: Vec<Fix>,
}

/// A further place, and its relation to the error.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The user file that has the place. `None`: the document.
    pub file: Option<String>,
    /// The place.
    pub span: TextSpan,
    /// Its relation to the error.
    pub text: String,
}

/// A change of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What it changes.
    pub title: String,
    /// The edits, in the order of the text. They do not overlap.
    pub edits: Vec<Edit>,
}

/// The replacement of a part of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The part.
    pub span: TextSpan,
    /// The text in its place.
    pub text: String,
}

impl Document<'_> {
    /// Returns the diagnostics with their fixes. The compiler runs once, and once for each fix that it tries.
    pub fn diagnostics(&self) -> Vec<Found> {
        let compiled = match self.compile_unless_too_long() {
            Ok(compiled) => compiled,
            Err(too_long) => return vec![*too_long],
        };
        let mut trials = fixes::Trials::new(self, &compiled);
        let mut found = self.found(&compiled);
        for (found, diagnostic) in found.iter_mut().zip(&compiled.diagnostics) {
            found.fixes = trials.fixes(diagnostic);
        }
        found
    }

    /// Returns the diagnostics without fixes: the compiler runs once.
    pub fn diagnostics_without_fixes(&self) -> Vec<Found> {
        match self.compile_unless_too_long() {
            Ok(compiled) => self.found(&compiled),
            Err(too_long) => vec![*too_long],
        }
    }

    /// Returns the text with these edits.
    pub fn with_edits(&self, edits: &[Edit]) -> String {
        let mut text = self.text.to_owned();
        for edit in edits.iter().rev() {
            if text.get(edit.span.bytes.clone()).is_some() {
                text.replace_range(edit.span.bytes.clone(), &edit.text);
            }
        }
        text
    }

    fn compile_unless_too_long(&self) -> Result<Compiled<'_>, Box<Found>> {
        if !self.is_too_long() {
            return Ok(self.compile());
        }
        let (length, most) = (self.text.len(), source_file::MAX_BYTES);
        let span = SourceSpan::new(self.path, 1, 1);
        let message = format!("a source of {length} bytes or more: it can have {most}");
        let help = "describe one buffer per file";
        let diagnostic = Diagnostic::new(fragbuf_model::codes::INVALID_TOKEN, &span, message, help);
        Err(Box::new(self.found_of(&diagnostic, &Lines::new(""), &[])))
    }

    fn found(&self, compiled: &Compiled<'_>) -> Vec<Found> {
        let lines = self.lines();
        compiled.diagnostics.iter().map(|diagnostic| self.found_of(diagnostic, &lines, &compiled.files)).collect()
    }

    fn found_of(&self, diagnostic: &Diagnostic, lines: &Lines<'_>, files: &[(String, String)]) -> Found {
        let place = |span: &SourceSpan| {
            if self.contains(span) {
                return (None, lines.source_span(span));
            }
            let text = files.iter().find(|(name, _)| **name == *span.file).map_or("", |(_, text)| text.as_str());
            (Some(span.file.to_string()), Lines::new(text).source_span(span))
        };
        let labels = diagnostic.labels.iter().map(|label| {
            let (file, span) = place(&label.span);
            Label { file, span, text: label.text.clone() }
        });
        let (file, span) = place(&diagnostic.span);
        Found {
            code: diagnostic.code.name,
            meaning: diagnostic.code.meaning,
            severity: diagnostic.severity(),
            message: diagnostic.message.clone(),
            help: diagnostic.help.clone(),
            file,
            span,
            labels: labels.collect(),
            fixes: Vec::new(),
        }
    }
}
