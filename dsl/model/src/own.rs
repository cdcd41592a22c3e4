//! A user's own WGSL file in place of a word of the registry: how a description names it, and where its row stands.
//!
//! Nothing here reads a file: a loader does, and adds the row to the registry before the rules run.

use fragbuf_templates::vocabulary::Row;

use crate::{Alternative, Origin};

/// Before the path, in the value of a choice and in the key of the row. No word of the registry has a colon.
const FILE: &str = "wgsl:";

impl Alternative {
    /// The value that stands for the file at `path`, which is relative to the description.
    pub fn value_of_file(path: &str) -> String {
        format!("{FILE}{path}")
    }

    /// The path, where the value is a file of the user's own.
    pub fn file(&self) -> Option<&str> {
        self.value.value.strip_prefix(FILE)
    }
}

/// A value as descriptions write it: a word, or `wgsl("path")`.
pub fn written(value: &str) -> String {
    value.strip_prefix(FILE).map_or_else(|| value.to_owned(), |path| format!("wgsl(\"{path}\")"))
}

/// The row in the head of a user's file, and the places of its lines.
#[derive(Clone, Debug)]
pub struct OwnRow {
    /// The row. Its passes have skeletons and uses only; the rest is taken from the registry.
    pub row: Row,
    /// Where its lines stand.
    pub places: RowPlaces,
}

/// Where the lines of a row stand.
#[derive(Clone, Debug)]
pub struct RowPlaces {
    /// The line that names the axis.
    pub row: Origin,
    /// The name of each buffer, in order.
    pub resources: Vec<Origin>,
    /// The name of each step, in order.
    pub steps: Vec<Origin>,
    /// The value of each default, in order.
    pub defaults: Vec<Origin>,
    /// The constant of each parameter, in order.
    pub parameters: Vec<Origin>,
}
