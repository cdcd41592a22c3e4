//! Diagnostics as the compiler's own errors.
//!
//! In: every mistake of a description, and its tokens. Out: a `compile_error!` for each, which the compiler shows at the
//! user's tokens: code and message, the other places, the way out.

use std::fmt::Write as _;

use fragbuf_model::{Diagnostic, Diagnostics};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use quote::{quote, quote_spanned};

use crate::place;

/// One `compile_error!` for each mistake.
pub(crate) fn all(faults: &Diagnostics, tokens: &TokenStream) -> TokenStream {
    faults.iter().map(|fault| one(fault, tokens)).collect()
}

fn one(fault: &Diagnostic, tokens: &TokenStream) -> TokenStream {
    let (first, last) = place::spans(&fault.origin, tokens);
    let message = message(fault);
    let mut arguments = Group::new(Delimiter::Brace, quote_spanned! { last=> #message });
    arguments.set_span(last);
    let arguments = TokenTree::from(arguments);
    let call = quote_spanned! { first=> ::core::compile_error! };
    quote! { #call #arguments }
}

fn message(fault: &Diagnostic) -> String {
    let mut text = format!("[{}] {}", fault.code.name, fault.message);
    for label in &fault.labels {
        let _ = write!(text, "\n{}: {}", label.origin, label.text);
    }
    let _ = write!(text, "\nhelp: {}", fault.hint);
    text
}
