//! Lines of WGSL, each with the place in the user's text that it comes from.
//!
//! In: lines without indentation. Out: text with 4 spaces per level, and as many places as lines.

use fragbuf_model::Origin;

use super::Lowered;

/// What is written so far.
#[derive(Default)]
pub(super) struct Lines {
    text: String,
    places: Vec<Origin>,
    level: usize,
}

impl Lines {
    pub(super) fn push(&mut self, line: String, origin: &Origin) {
        for _ in 0..self.level {
            self.text.push_str("    ");
        }
        self.text.push_str(&line);
        self.text.push('\n');
        self.places.push(origin.clone());
    }

    pub(super) fn indent(&mut self) {
        self.level += 1;
    }

    pub(super) fn dedent(&mut self) {
        self.level = self.level.saturating_sub(1);
    }

    pub(super) fn finish(self) -> Lowered {
        Lowered { text: self.text, lines: self.places }
    }
}
