//! Writes linked declarations under a banner per source, and records where every line comes from.
//!
//! In: items in order. Out: the text and its line map.

use super::fold::Folded;
use super::{Item, Renames, Source};
use crate::program::{LineMap, LineOrigin};

/// A text so far, and where its lines come from.
pub(super) struct Writer {
    pub(super) text: String,
    pub(super) lines: LineMap,
}

impl Writer {
    /// The name of a source, and its head.
    pub(super) fn banner(&mut self, source: &Source, head: &str) {
        self.blank_line();
        self.text.push_str("// ---- ");
        self.text.push_str(&source.name);
        self.text.push('\n');
        self.text.push_str(head);
        self.lines.skip(1 + head.lines().count());
    }

    fn blank_line(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
            self.lines.skip(1);
        }
    }

    /// An item after folding.
    pub(super) fn folded(&mut self, source: &Source, item: &Item<'_>, folded: &Folded, prefixed: &Renames) {
        self.blank_line();
        self.text.push_str(&prefixed.apply(&folded.text));
        self.text.push('\n');
        let mut rest = folded.lines.as_slice();
        while let Some(&first) = rest.first() {
            let length = (first..).zip(rest).take_while(|(expected, line)| expected == *line).count();
            let line = item.first_line + first;
            self.lines.run(length, LineOrigin::Source { name: source.name.clone(), line });
            rest = &rest[length..];
        }
        self.blank_line();
    }

    /// An item as it was written.
    pub(super) fn item(&mut self, source: &Source, item: &Item<'_>, prefixed: &Renames) {
        if !item.is_short {
            self.blank_line();
        }
        self.text.push_str(&prefixed.apply(item.text));
        self.text.push('\n');
        let lines = item.text.lines().count();
        match &source.origins {
            Some(origins) => {
                for at in (item.first_line..).take(lines) {
                    self.lines.run(1, origins.get(at - 1).cloned().unwrap_or(LineOrigin::None));
                }
            }
            None => self.lines.run(lines, LineOrigin::Source { name: source.name.clone(), line: item.first_line }),
        }
        if !item.is_short {
            self.blank_line();
        }
    }
}
