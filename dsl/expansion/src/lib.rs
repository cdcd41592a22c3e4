//! What the macros of the language expand to, as plain functions: tests and benches call them without a compiler.
//!
//! In: `[path of the serving crate]`, then the user's tokens. Out: a module for a description, an expression for a
//! function of the builder. A mistake is a `compile_error!` at the user's token, and what can be emitted beside it is,
//! so that an editor goes on completing. Reading and checking are `fragbuf-syntax`'s and `fragbuf-model`'s.

mod bindings;
mod errors;
mod front;
mod functions;
mod module;
mod names;
mod place;
mod structs;

use fragbuf_model::Draft;
use fragbuf_syntax::{Captured, Written, read_tokens};
use fragbuf_templates::Registry;
use proc_macro2::TokenStream;
use quote::quote;

use front::Front;
use module::{Bodies, Source};

/// The module of a description: `[$crate] buffer Glass from kplus_array { … }`, documentation and visibility in front.
/// It is checked against fragbuf's own registry.
pub fn fragment_buffer(input: TokenStream) -> TokenStream {
    let front = Front::of(input);
    let (parsed, written) = read_tokens(front.tokens.clone(), &place::of);
    let registry = Registry::builtin();
    let (bindings, bodies, errors) = match parsed.check(&registry) {
        Ok(variant) => (bindings::module(&variant, &registry), Bodies::Compiled, None),
        Err(faults) => (TokenStream::new(), Bodies::ForEditors, Some(errors::all(&faults, &front.tokens))),
    };
    let module = parsed.draft.map(|draft| emit(&front, &draft, &written, (bodies, bindings)));
    quote! { #errors #module }
}

/// The module of a description that need not be whole: the grammar and the types are checked, nothing is looked up in a
/// registry. `None` where anything is wrong.
pub fn unchecked_fragment_buffer(input: TokenStream) -> Option<TokenStream> {
    let front = Front::of(input);
    let (parsed, written) = read_tokens(front.tokens.clone(), &place::of);
    let draft = parsed.draft.filter(|_| parsed.diagnostics.is_empty())?;
    Some(emit(&front, &draft, &written, (Bodies::Compiled, TokenStream::new())))
}

/// A closure for the builder: `[$crate] |f| f.depth`.
pub fn closure(input: TokenStream) -> TokenStream {
    let (front, captured) = captured(input);
    let serving = front.serving;
    quote! { #serving::builder::Closure::captured(#captured) }
}

/// A helper function for the builder: `[$crate] fn name(x: f32) -> f32 { … }`.
pub fn function(input: TokenStream) -> TokenStream {
    let (front, captured) = captured(input);
    let serving = front.serving;
    quote! { #serving::builder::Function::captured(#captured) }
}

fn emit(front: &Front, draft: &Draft, written: &[Written], (bodies, bindings): (Bodies, TokenStream)) -> TokenStream {
    let description = module::captured(&front.serving, &Captured::of(&front.tokens, &place::of));
    module::module(&Source { front, draft, written, description, bodies, bindings })
}

fn captured(input: TokenStream) -> (Front, TokenStream) {
    let front = Front::plain(input);
    let captured = module::captured(&front.serving, &Captured::of(&front.tokens, &place::of));
    (front, captured)
}
