//! Conversion between tokens and source spans.
//!
//! Input: spans of the compiler, or of `proc_macro2` outside of one. Output: the file, line and column that the compiler
//! itself shows; and, for the span of a diagnostic, the tokens that it covers.

use std::sync::Arc;

use fragbuf_model::SourceSpan;
use proc_macro2::{Span, TokenStream, TokenTree};

/// Returns the source span. A span over several lines gets length 1: the compiler shows its beginning.
pub(crate) fn source_span(span: Span) -> SourceSpan {
    let (start, end) = (span.start(), span.end());
    let length = if end.line == start.line { end.column.saturating_sub(start.column) } else { 1 };
    let file: Arc<str> = span.file().into();
    SourceSpan::new(file, number(start.line.max(1)), number(start.column + 1)).with_length(number(length))
}

fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// Returns the spans of the first and the last token in `source`; the span of the whole call if there is none.
pub(crate) fn token_spans(source: &SourceSpan, tokens: &TokenStream) -> (Span, Span) {
    let mut found = None;
    visit(tokens, &mut |span| {
        let start = source_span(span);
        let columns = source.column..source.column.saturating_add(source.length);
        if start.line == source.line && columns.contains(&start.column) {
            let (first, _) = found.unwrap_or((span, span));
            found = Some((first, span));
        }
    });
    found.unwrap_or((Span::call_site(), Span::call_site()))
}

/// Returns the span of the first token in `source`.
pub(crate) fn token_span(source: &SourceSpan, tokens: &TokenStream) -> Span {
    token_spans(source, tokens).0
}

fn visit(tokens: &TokenStream, visitor: &mut impl FnMut(Span)) {
    for token in tokens.clone() {
        match token {
            TokenTree::Group(group) => {
                visitor(group.span_open());
                visit(&group.stream(), visitor);
                visitor(group.span_close());
            }
            other => visitor(other.span()),
        }
    }
}
