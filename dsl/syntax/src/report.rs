//! Collects the errors of one description, and maps token spans to the user's source.

use fragbuf_model::{Code, Diagnostic, Diagnostics, SourceSpan};
use proc_macro2::Span;

use crate::inspection::{Candidate, Name, is_placeholder};

/// The greatest number of errors that are kept. A reader needs no more.
const MAX_ERRORS: usize = 200;

/// The label of the first of two duplicates.
pub(crate) const FIRST: &str = "first given here";

/// The mark that an error was reported and that the rest of the item is not parsed.
pub(crate) struct Stop;

/// The errors so far, and the function from token spans to source spans.
pub(crate) struct Report<'a> {
    locate: &'a dyn Fn(Span) -> SourceSpan,
    diagnostics: Diagnostics,
    count: usize,
    /// The names in functions, and what can be in the place of the placeholder. `None`: they are not collected.
    names: Option<(Vec<Name>, Vec<Candidate>)>,
}

impl<'a> Report<'a> {
    /// Returns an empty report.
    pub(crate) fn new(locate: &'a dyn Fn(Span) -> SourceSpan) -> Self {
        Report { locate, diagnostics: Diagnostics::new(), count: 0, names: None }
    }

    /// Collects the names in functions, too.
    pub(crate) fn with_names(mut self) -> Self {
        self.names = Some((Vec::new(), Vec::new()));
        self
    }

    /// Returns whether names are collected.
    pub(crate) fn has_names(&self) -> bool {
        self.names.is_some()
    }

    /// Tests whether a name stands for the one that is being typed. It does only while names are collected: in other texts it is a name
    /// like others.
    pub(crate) fn is_placeholder(&self, name: &str) -> bool {
        self.has_names() && is_placeholder(name)
    }

    /// Adds a name, if names are collected.
    pub(crate) fn name(&mut self, name: Name) {
        if let Some((names, _)) = &mut self.names {
            names.push(name);
        }
    }

    /// Sets what can be in the place of the placeholder, which is written once. A function may be checked after its signature.
    pub(crate) fn candidates(&mut self, found: impl IntoIterator<Item = Candidate>) {
        if let Some((_, candidates)) = &mut self.names
            && candidates.is_empty()
        {
            candidates.extend(found);
        }
    }

    /// Takes the names and the candidates.
    pub(crate) fn take_names(&mut self) -> (Vec<Name>, Vec<Candidate>) {
        self.names.take().unwrap_or_default()
    }

    /// Returns the position of a token span in the user's source.
    pub(crate) fn at(&self, span: Span) -> SourceSpan {
        (self.locate)(span)
    }

    /// Adds an error.
    pub(crate) fn error(&mut self, code: Code, span: &SourceSpan, message: impl Into<String>, help: impl Into<String>) {
        self.push(Diagnostic::new(code, span, message, help));
    }

    /// Adds an error that may have labels.
    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        self.count += 1;
        if self.count <= MAX_ERRORS {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Returns the number of errors so far. A caller compares two counts to learn whether a part had errors.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Returns the kept errors in source order, without duplicates.
    pub(crate) fn finish(self) -> Diagnostics {
        match self.diagnostics.into_result(()) {
            Ok(()) => Diagnostics::new(),
            Err(sorted) => sorted,
        }
    }
}
