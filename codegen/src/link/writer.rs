//! Writes linked declarations under a banner per source, and records the origin of every line.
//!
//! Input: items in order. Output: the source and its source map.

use super::folded::FoldedFunction;
use super::item::Item;
use super::rename::Renames;
use super::source::Source;
use crate::source_map::{LineSource, SourceMap};

/// The source that has been written, and its source map.
pub(super) struct Writer {
    pub(super) text: String,
    pub(super) lines: SourceMap,
}

impl Writer {
    /// Writes the name and the header of a source.
    pub(super) fn banner(&mut self, source: &Source, header: &str) {
        self.blank_line();
        self.text.push_str("// ---- ");
        self.text.push_str(&source.name);
        self.text.push('\n');
        self.text.push_str(header);
        self.lines.skip(1 + header.lines().count());
    }

    fn blank_line(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
            self.lines.skip(1);
        }
    }

    /// Writes an item after folding.
    pub(super) fn folded(&mut self, source: &Source, item: &Item<'_>, folded: &FoldedFunction, prefixed: &Renames) {
        self.blank_line();
        self.text.push_str(&prefixed.apply(&folded.text));
        self.text.push('\n');
        let mut rest = folded.lines.as_slice();
        while let Some(&first) = rest.first() {
            let length = (first..).zip(rest).take_while(|(expected, line)| expected == *line).count();
            let line = item.first_line + first;
            self.lines.run(length, LineSource::Source { name: source.name.clone(), line });
            rest = &rest[length..];
        }
        self.blank_line();
    }

    /// Writes an item as it is in its source.
    pub(super) fn item(&mut self, source: &Source, item: &Item<'_>, prefixed: &Renames) {
        if !item.is_short {
            self.blank_line();
        }
        self.text.push_str(&prefixed.apply(item.text));
        self.text.push('\n');
        let lines = item.text.lines().count();
        match &source.spans {
            Some(spans) => {
                for line in (item.first_line..).take(lines) {
                    self.lines.run(1, spans.get(line - 1).cloned().unwrap_or(LineSource::None));
                }
            }
            None => self.lines.run(lines, LineSource::Source { name: source.name.clone(), line: item.first_line }),
        }
        if !item.is_short {
            self.blank_line();
        }
    }
}
