//! Where mistakes are gathered while a description is read, and how a token's place becomes the user's.

use fragbuf_model::{Code, Diagnostic, Diagnostics, Origin};
use proc_macro2::Span;

/// How many mistakes are kept. A text with more is not a description that went wrong, and nobody reads that far.
const MOST: usize = 200;

/// The mistakes so far, and the door's way from a span to a place.
pub(crate) struct Report<'a> {
    place: &'a dyn Fn(Span) -> Origin,
    diagnostics: Diagnostics,
    count: usize,
}

impl<'a> Report<'a> {
    /// None yet.
    pub(crate) fn new(place: &'a dyn Fn(Span) -> Origin) -> Self {
        Report { place, diagnostics: Diagnostics::new(), count: 0 }
    }

    /// Where this span stands in the user's text.
    pub(crate) fn at(&self, span: Span) -> Origin {
        (self.place)(span)
    }

    /// Adds a mistake.
    pub(crate) fn error(&mut self, code: Code, origin: &Origin, message: impl Into<String>, hint: impl Into<String>) {
        self.push(Diagnostic::new(code, origin, message, hint));
    }

    /// Adds a mistake that may have labels.
    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        self.count += 1;
        if self.count <= MOST {
            self.diagnostics.push(diagnostic);
        }
    }

    /// How many mistakes there are: a caller that saw fewer before knows that its part is wrong.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Those that were kept, in the order of the user's text, each once.
    pub(crate) fn finish(self) -> Diagnostics {
        match self.diagnostics.gate(()) {
            Ok(()) => Diagnostics::new(),
            Err(sorted) => sorted,
        }
    }
}
