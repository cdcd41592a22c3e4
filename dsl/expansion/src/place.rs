//! From a token to its place, and back.
//!
//! In: spans of the compiler, or of `proc_macro2` outside of one. Out: the file, line and column that the compiler itself
//! would show; and, for a place of a diagnostic, the tokens that stand there.

use std::sync::Arc;

use fragbuf_model::Origin;
use proc_macro2::{Span, TokenStream, TokenTree};

/// Where a span stands. One that goes over several lines is one character long: the compiler shows its beginning.
pub(crate) fn of(span: Span) -> Origin {
    let (start, end) = (span.start(), span.end());
    let length = if end.line == start.line { end.column.saturating_sub(start.column) } else { 1 };
    let file: Arc<str> = span.file().into();
    Origin::new(file, number(start.line.max(1)), number(start.column + 1)).with_length(number(length))
}

fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// The first and the last span at this place; the whole call where nothing stands there.
pub(crate) fn spans(origin: &Origin, tokens: &TokenStream) -> (Span, Span) {
    let mut found = None;
    visit(tokens, &mut |span| {
        let place = of(span);
        let covered = origin.column..origin.column.saturating_add(origin.length);
        if place.line == origin.line && covered.contains(&place.column) {
            let (first, _) = found.unwrap_or((span, span));
            found = Some((first, span));
        }
    });
    found.unwrap_or((Span::call_site(), Span::call_site()))
}

/// The span of the token at this place.
pub(crate) fn span(origin: &Origin, tokens: &TokenStream) -> Span {
    spans(origin, tokens).0
}

fn visit(tokens: &TokenStream, seen: &mut impl FnMut(Span)) {
    for token in tokens.clone() {
        match token {
            TokenTree::Group(group) => {
                seen(group.span_open());
                visit(&group.stream(), seen);
                seen(group.span_close());
            }
            other => seen(other.span()),
        }
    }
}
