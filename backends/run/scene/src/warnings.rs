//! What a reader of a model replaced by a default, and what it did not read.
//!
//! A reader adds a warning where other readers of the format go on. Equal warnings are counted, and only the first has its position, so
//! the list is short whatever the file has.

use std::cell::RefCell;
use std::fmt;

use crate::error::{FilePosition, located};
use crate::text::beginning;

/// A part of a model that was replaced by a default, or was not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// What it is about.
    pub kind: WarningKind,
    /// The file.
    pub file: String,
    /// The position of the first occurrence in the file.
    pub position: FilePosition,
    /// What is missing, malformed or not read.
    pub message: String,
    /// What is used in place of it; empty: the message says so, or nothing is.
    pub instead: String,
    /// The number of further occurrences.
    pub more: u64,
}

/// What a warning is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WarningKind {
    /// A file that the model names does not exist.
    MissingFile,
    /// A material is not defined.
    MissingMaterial,
    /// The file has no scene with nodes.
    MissingScene,
    /// A normal does not exist, or is not finite. It is computed.
    InvalidNormal,
    /// A value of an attribute is not finite. It is 0.
    InvalidAttribute,
    /// A part of the model has no attribute that others have. It is 0.
    MissingAttribute,
    /// A face has fewer than three corners. It is skipped.
    DegenerateFace,
    /// A statement is unknown, or is not where it has a meaning. It is skipped.
    UnknownStatement,
    /// A number is outside of its range, or is one too many.
    OutOfRange,
    /// A material is invisible, perhaps by mistake.
    Invisible,
    /// A part of the model that changes the image is not read.
    NotRead,
}

impl WarningKind {
    /// Every kind.
    pub const ALL: [WarningKind; 11] = [
        WarningKind::MissingFile,
        WarningKind::MissingMaterial,
        WarningKind::MissingScene,
        WarningKind::InvalidNormal,
        WarningKind::InvalidAttribute,
        WarningKind::MissingAttribute,
        WarningKind::DegenerateFace,
        WarningKind::UnknownStatement,
        WarningKind::OutOfRange,
        WarningKind::Invisible,
        WarningKind::NotRead,
    ];

    /// Returns the code of the warning in messages.
    pub fn code(self) -> &'static str {
        match self {
            WarningKind::MissingFile => "missing-file",
            WarningKind::MissingMaterial => "missing-material",
            WarningKind::MissingScene => "missing-scene",
            WarningKind::InvalidNormal => "invalid-normal",
            WarningKind::InvalidAttribute => "invalid-attribute",
            WarningKind::MissingAttribute => "missing-attribute",
            WarningKind::DegenerateFace => "degenerate-face",
            WarningKind::UnknownStatement => "unknown-statement",
            WarningKind::OutOfRange => "out-of-range",
            WarningKind::Invisible => "invisible",
            WarningKind::NotRead => "not-read",
        }
    }
}

impl Warning {
    /// Returns the warning for a caller that rejects the model: nothing is used in place of the part.
    pub fn without_instead(&self) -> Warning {
        Warning { instead: String::new(), ..self.clone() }
    }
}

/// The message of a warning.
pub(crate) struct Message {
    text: String,
    instead: String,
}

impl Message {
    /// Returns a message about a part, and what is used in place of it.
    pub(crate) fn new(text: impl Into<String>, instead: impl Into<String>) -> Self {
        Message { text: text.into(), instead: instead.into() }
    }
}

impl From<String> for Message {
    fn from(text: String) -> Self {
        Message::new(text, "")
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let separator = if self.instead.is_empty() { "" } else { ": " };
        let message = format!("{}{separator}{}", self.message, self.instead);
        located(f, &self.file, self.position, &message)?;
        match self.more {
            0 => Ok(()),
            more => write!(f, " (and {more} more)"),
        }
    }
}

/// The number of warnings after which only the first of each kind is listed.
const MAX_WARNINGS: usize = 24;

/// The greatest length of a subject in characters.
const MAX_SUBJECT: usize = 60;

/// The warnings of a scene so far, each with its subject.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    list: RefCell<Vec<(String, Warning)>>,
}

/// Adds warnings about one file.
#[derive(Clone, Copy)]
pub(crate) struct FileWarnings<'a> {
    warnings: &'a Warnings,
    file: &'a str,
}

impl Warnings {
    pub(crate) fn in_file<'a>(&'a self, file: &'a str) -> FileWarnings<'a> {
        FileWarnings { warnings: self, file }
    }

    pub(crate) fn into_list(self) -> Vec<Warning> {
        self.list.into_inner().into_iter().map(|(_, warning)| warning).collect()
    }
}

impl<'a> FileWarnings<'a> {
    /// Returns the name of the file.
    pub(crate) fn file(self) -> &'a str {
        self.file
    }

    /// Adds a warning with the position and the message that `found` returns, or counts it if there is one of this kind about the same subject.
    pub(crate) fn add<M: Into<Message>>(
        self,
        kind: WarningKind,
        subject: &str,
        found: impl FnOnce() -> (FilePosition, M),
    ) {
        let subject = beginning(subject, MAX_SUBJECT);
        let mut list = self.warnings.list.borrow_mut();
        let is_full = list.len() >= MAX_WARNINGS;
        let is_equal = |(other, warning): &&mut (String, Warning)| {
            warning.kind == kind && (is_full || (warning.file == self.file && *other == subject))
        };
        match list.iter_mut().find(is_equal) {
            Some((_, warning)) => warning.more = warning.more.saturating_add(1),
            None => {
                let (position, message) = found();
                let Message { text: message, instead } = message.into();
                let warning = Warning { kind, file: self.file.to_owned(), position, message, instead, more: 0 };
                list.push((subject.to_owned(), warning));
            }
        }
    }

    /// Adds a warning about a line, or counts it.
    pub(crate) fn line<M: Into<Message>>(
        self,
        kind: WarningKind,
        subject: &str,
        line: usize,
        message: impl FnOnce() -> M,
    ) {
        self.add(kind, subject, || (FilePosition::Line(line), message()));
    }
}
