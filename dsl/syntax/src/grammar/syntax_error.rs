//! Errors of functions that are not Rust.
//!
//! Input: the tokens of a function, and syn's error. Output: the error with a fix, at the part that has to change: syn reports a missing
//! `;` at the statement after it.

use fragbuf_model::codes;
use proc_macro2::{Span, TokenStream, TokenTree};

use super::c_syntax::{self, Foreign};
use super::cursor::{described_end, end_of};
use crate::report::Report;

/// Reports tokens that are not Rust.
pub(super) fn syntax_error(tokens: &TokenStream, error: &syn::Error, report: &mut Report) {
    if let Some(Foreign { span, message, help }) = c_syntax::find(tokens) {
        report.error(codes::UNEXPECTED_TOKEN, &report.at(span), format!("invalid Rust syntax: {message}"), help);
        return;
    }
    // A missing `;` belongs to the statement before the token that is not expected.
    let last = token_before(tokens, error.span()).filter(|_| is_missing_semicolon(error));
    let (span, after) = match last {
        Some(last) => (report.at(end_of(&last)), format!(" after `{}`", described_end(&last))),
        None => (report.at(error.span()), String::new()),
    };
    let message = format!("invalid Rust syntax: {error}{after}");
    report.error(codes::UNEXPECTED_TOKEN, &span, message, syntax_help(&error.to_string()));
}

fn is_missing_semicolon(error: &syn::Error) -> bool {
    error.to_string().ends_with("expected `;`")
}

/// Returns the token before the one at `at`, inside the same brackets. Spans are compared before they are mapped to the user's source:
/// all tokens of source that a program generated have one place there.
fn token_before(tokens: &TokenStream, at: Span) -> Option<TokenTree> {
    let mut last: Option<TokenTree> = None;
    for token in tokens.clone() {
        let begin = match &token {
            TokenTree::Group(group) => group.span_open(),
            other => other.span(),
        };
        if begin.start() == at.start() {
            return last;
        }
        if let TokenTree::Group(group) = &token
            && let Some(found) = token_before(&group.stream(), at)
        {
            return Some(found);
        }
        last = Some(token);
    }
    None
}

fn syntax_help(message: &str) -> &'static str {
    if message.contains("expected `;`") {
        "end the statement with `;`"
    } else if message.contains("unexpected end of input") {
        "add the missing code before this position"
    } else if message.contains("expected `:`") {
        "give each parameter its type, after its name: `x: f32`"
    } else {
        "functions use Rust syntax: check this token and the one before it"
    }
}
