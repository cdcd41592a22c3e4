//! Loads the description that a request has as its text, and bounds the files that it reads.

use std::path::{Component, Path, PathBuf};

use fragbuf::analysis::Document;
use fragbuf::load::{self, Description};
use fragbuf::{Diagnostic, Diagnostics, Registry, Variant, parse};
use fragbuf_model::codes;

use super::problem::Problem;

/// The name of the description in messages.
pub(in crate::cli) const NAME: &str = "description.fragbuf";

/// The folder that descriptions read user files from.
#[derive(Clone, Debug)]
pub(super) struct Folder(pub(super) Option<PathBuf>);

impl Folder {
    /// Returns the file that messages name, whose folder is the one of user files.
    pub(super) fn file(&self) -> String {
        self.0.as_ref().map_or_else(|| NAME.to_owned(), |folder| folder.join(NAME).display().to_string())
    }

    /// Returns the text for analysis. User files are read if all of them are in the folder.
    pub(super) fn document<'a>(&self, text: &'a str, file: &'a str, registry: &'a Registry) -> Document<'a> {
        let document = Document::new(text, file, registry);
        match self.0.is_some() && self.refused(text, file).is_none() {
            true => document.with_files(),
            false => document,
        }
    }

    /// Loads a description that must have no errors. Files outside of the folder are errors, and are not opened.
    pub(super) fn variant(&self, text: &str, registry: &Registry) -> Result<Variant, Problem> {
        let file = self.file();
        let loaded = match self.refused(text, &file) {
            Some(errors) => Err(errors),
            // Messages of `load` name files that are at hand, and without a folder none is.
            None if self.0.is_none() => parse(text, &file).check(registry),
            None => load::variant(&Description::Text { file, text: text.to_owned() }, &[], registry),
        };
        loaded.map_err(|errors| Problem::input(sentence(&errors)))
    }

    /// Checks the files that the description names, before a command reads it.
    pub(super) fn check(&self, text: &str) -> Result<(), Problem> {
        self.refused(text, NAME).map_or(Ok(()), |errors| Err(Problem::input(sentence(&errors))))
    }

    /// Returns the errors for the files that the description names and that it may not read.
    pub(super) fn refused(&self, text: &str, file: &str) -> Option<Diagnostics> {
        let draft = parse(text, file).draft?;
        let alternatives = draft.choices.iter().flat_map(|choice| &choice.alternatives);
        let outside = alternatives.filter_map(|alternative| {
            let path = alternative.file()?;
            let (message, help) = match &self.0 {
                None => (
                    format!("`{path}` is not read: this playground has no folder of files"),
                    "end it, and give the folder: `fragbuf playground FOLDER`",
                ),
                Some(folder) if !is_inside(folder, Path::new(path)) => (
                    format!("`{path}` is not read: it is outside of the folder of this playground"),
                    "copy the file into the folder",
                ),
                Some(_) => return None,
            };
            Some(Diagnostic::new(codes::MISSING_FILE, &alternative.value.span, message, help))
        });
        let errors: Diagnostics = outside.collect();
        (!errors.is_empty()).then_some(errors)
    }
}

/// Tests whether a path is that of a file in the folder, after all links. A file that does not exist is, unless its path leaves the folder.
fn is_inside(folder: &Path, path: &Path) -> bool {
    let is_below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    is_below && folder.join(path).canonicalize().map_or(true, |found| found.starts_with(folder))
}

/// Returns errors as one sentence per line.
pub(super) fn sentence(errors: &Diagnostics) -> String {
    let line =
        |error: &Diagnostic| format!("{}:{}: {}: {}", error.span.line, error.span.column, error.message, error.help);
    errors.iter().map(line).collect::<Vec<_>>().join("\n")
}
