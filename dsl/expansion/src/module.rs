//! The module of a description.
//!
//! In: the draft, the functions as written, and what stood in front. Out: one module, named after the buffer, that names
//! nothing but its own items, `::core`, and the serving crate.

use fragbuf_model::Draft;
use fragbuf_syntax::{Captured, Written};
use proc_macro2::TokenStream;
use quote::quote;

use crate::front::Front;
use crate::{functions, names, place, structs};

/// Everything that a module is made of.
pub(crate) struct Source<'a> {
    pub front: &'a Front,
    pub draft: &'a Draft,
    pub written: &'a [Written],
    /// The description for the running program.
    pub description: TokenStream,
    pub bodies: Bodies,
    /// The module of binding numbers; empty where there is no plan.
    pub bindings: TokenStream,
}

/// Who gets the bodies of the user's functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bodies {
    /// Everyone: nothing is wrong.
    Compiled,
    /// Editors only, to complete in them.
    ForEditors,
}

/// The module.
pub(crate) fn module(source: &Source) -> TokenStream {
    let Front { serving, documentation, visibility, tokens } = source.front;
    let buffer = &source.draft.name;
    let name = names::module(&buffer.value, place::span(&buffer.origin, tokens));
    let about = format!("The fragment buffer `{}`.", buffer.value);
    let about = if documentation.is_empty() {
        quote! { #[doc = #about] }
    } else {
        documentation.clone()
    };
    let (fragment, uniforms) = (structs::fragment(source), structs::uniforms(source));
    let functions = functions::all(source);
    let (description, bindings) = (&source.description, &source.bindings);
    quote! {
        #about
        #[allow(dead_code, deprecated, unexpected_cfgs, unreachable_pub, unused_imports, unused_parens, clippy::all)]
        #visibility mod #name {
            #fragment
            #uniforms
            #functions
            #bindings

            /// The description, with the places where it was written.
            pub const DESCRIPTION: #serving::Captured = #description;

            /// The description as data. It is read again at each call.
            pub fn draft() -> #serving::Draft {
                DESCRIPTION.draft()
            }

            /// The description, checked against fragbuf's own registry.
            pub fn variant() -> ::core::result::Result<#serving::Variant, #serving::Diagnostics> {
                DESCRIPTION.parse().check(&#serving::Registry::builtin())
            }
        }
    }
}

/// The expression for captured tokens.
pub(crate) fn captured(serving: &TokenStream, captured: &Captured) -> TokenStream {
    let (file, text, places) = captured.parts();
    quote! { #serving::Captured::new(#file, #text, #places) }
}
