//! Lines of WGSL, each with the span in the user's source that it was lowered from.
//!
//! Input: lines without indentation. Output: source with 4 spaces per level, and one span per line.

use fragbuf_model::SourceSpan;

/// A function in WGSL.
pub(crate) struct WgslFunction {
    pub source: String,
    /// The span of each line.
    pub lines: Vec<SourceSpan>,
}

/// The lines so far.
#[derive(Default)]
pub(super) struct Lines {
    source: String,
    spans: Vec<SourceSpan>,
    level: usize,
}

impl Lines {
    pub(super) fn push(&mut self, line: String, span: &SourceSpan) {
        for _ in 0..self.level {
            self.source.push_str("    ");
        }
        self.source.push_str(&line);
        self.source.push('\n');
        self.spans.push(span.clone());
    }

    pub(super) fn indent(&mut self) {
        self.level += 1;
    }

    pub(super) fn dedent(&mut self) {
        self.level = self.level.saturating_sub(1);
    }

    pub(super) fn finish(self) -> WgslFunction {
        WgslFunction { source: self.source, lines: self.spans }
    }
}
