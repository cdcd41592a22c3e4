//! User files: a description can name a WGSL file instead of a value of the registry, and the file declares a row.
//!
//! This module reads no file: a loader reads it and adds the row to the registry before the rules run.

use fragbuf_templates::vocabulary::Row;

use crate::{Alternative, SourceSpan};

/// The prefix of the path, in the value of a choice and in the key of the row. No key of the registry has a colon.
const FILE: &str = "wgsl:";

impl Alternative {
    /// Returns the value for the file at `path`, which is relative to the description.
    pub fn value_of_file(path: &str) -> String {
        format!("{FILE}{path}")
    }

    /// Returns the path if the value is a user file.
    pub fn file(&self) -> Option<&str> {
        self.value.value.strip_prefix(FILE)
    }
}

/// Returns a value as descriptions write it: a key, or `wgsl("path")`.
pub(crate) fn value_source(value: &str) -> String {
    value.strip_prefix(FILE).map_or_else(|| value.to_owned(), |path| format!("wgsl(\"{path}\")"))
}

/// The row in the header of a user file, with the spans of its lines.
#[derive(Clone, Debug)]
pub struct UserRow {
    /// The row. Its passes have only skeletons and uses; the registry gives the rest.
    pub row: Row,
    /// The spans of its lines.
    pub spans: RowSpans,
}

/// The spans of the lines of a row.
#[derive(Clone, Debug)]
pub struct RowSpans {
    /// The line that names the axis.
    pub row: SourceSpan,
    /// The name of each buffer, in order.
    pub resources: Vec<SourceSpan>,
    /// The name of each step, in order.
    pub steps: Vec<SourceSpan>,
    /// The value of each default, in order.
    pub defaults: Vec<SourceSpan>,
    /// The constant of each parameter, in order.
    pub parameters: Vec<SourceSpan>,
}
