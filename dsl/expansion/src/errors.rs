//! Diagnostics as errors of the compiler.
//!
//! Input: every error of a description, and its tokens. Output: a `compile_error!` for each, which the compiler shows at
//! the user's tokens: code and message, the labels, the help.

use std::fmt::Write as _;

use fragbuf_model::{Diagnostic, Diagnostics};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use quote::{quote, quote_spanned};

use crate::span;

/// Returns one `compile_error!` for each diagnostic.
pub(crate) fn compile_errors(diagnostics: &Diagnostics, tokens: &TokenStream) -> TokenStream {
    diagnostics.iter().map(|diagnostic| compile_error(diagnostic, tokens)).collect()
}

fn compile_error(diagnostic: &Diagnostic, tokens: &TokenStream) -> TokenStream {
    let (first, last) = span::token_spans(&diagnostic.span, tokens);
    let message = message(diagnostic);
    let mut arguments = Group::new(Delimiter::Brace, quote_spanned! { last=> #message });
    arguments.set_span(last);
    let arguments = TokenTree::from(arguments);
    let call = quote_spanned! { first=> ::core::compile_error! };
    quote! { #call #arguments }
}

fn message(diagnostic: &Diagnostic) -> String {
    let mut text = format!("[{}] {}", diagnostic.code.name, diagnostic.message);
    for label in &diagnostic.labels {
        let _ = write!(text, "\n{}: {}", label.span, label.text);
    }
    let _ = write!(text, "\nhelp: {}", diagnostic.help);
    text
}
