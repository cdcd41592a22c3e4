//! The module of a description.
//!
//! Input: the draft, the tokens of its functions, and the macro's input. Output: one module, named after the buffer. It names
//! only its own items, `::core`, and the serving crate.

use proc_macro2::TokenStream;
use quote::quote;

use crate::macro_input::MacroInput;
use crate::module_source::{Bodies, ModuleSource};
use crate::{functions, names, span, structs, textures};

/// Returns the module.
pub(crate) fn module(source: &ModuleSource) -> TokenStream {
    let MacroInput { serving, documentation, visibility, tokens } = source.input;
    let buffer = &source.draft.name;
    let name = names::module(&buffer.value, span::token_span(&buffer.span, tokens));
    let about = format!("The fragment buffer `{}`.", buffer.value);
    let about = if documentation.is_empty() {
        quote! { #[doc = #about] }
    } else {
        documentation.clone()
    };
    let (fragment, uniforms) = (structs::fragment(source), structs::uniforms(source));
    let textures = textures::textures(source);
    let functions = functions::functions(source);
    let description = &source.description;
    // Binding numbers follow from the plan, which the language does not have: a serving crate that has it emits them.
    let bindings = (source.bodies == Bodies::Compiled).then(|| quote! { #serving::bindings! { #tokens } });
    quote! {
        #about
        #[allow(dead_code, deprecated, unexpected_cfgs, unreachable_pub, unused_imports, unused_parens, clippy::all)]
        #visibility mod #name {
            #fragment
            #uniforms
            #textures
            #functions
            #bindings

            /// The description, with the source span of every token.
            pub const DESCRIPTION: #serving::CapturedTokens = #description;

            /// Returns the description as data. Each call parses it again.
            pub fn draft() -> #serving::Draft {
                DESCRIPTION.draft()
            }

            /// Checks the description against fragbuf's own registry.
            pub fn variant() -> ::core::result::Result<#serving::Variant, #serving::Diagnostics> {
                DESCRIPTION.parse().check(&#serving::Registry::builtin())
            }
        }
    }
}
