//! The expansions of the language's macros, as plain functions that tests and benches call without a compiler.
//!
//! Input: `[path of the serving crate]`, then the user's tokens. Output: a module for a description, an expression for a
//! function of the builder. An error becomes a `compile_error!` at the user's token; the rest is still emitted, so that
//! an editor can complete. `fragbuf-syntax` reads and `fragbuf-model` checks.

mod errors;
mod functions;
mod macro_input;
mod module;
mod module_source;
mod names;
mod span;
mod structs;
mod textures;

use fragbuf_model::Draft;
use fragbuf_syntax::{CapturedTokens, FunctionTokens, read_tokens};
use fragbuf_templates::Registry;
use proc_macro2::TokenStream;
use quote::quote;

use macro_input::MacroInput;
use module_source::{Bodies, ModuleSource};

/// Returns the module of a description: `[$crate] buffer Glass from kplus_array { … }`, with documentation and visibility
/// before `buffer`. The description is checked against fragbuf's own registry.
pub fn fragment_buffer(input: TokenStream) -> TokenStream {
    let input = MacroInput::of_description(input);
    let (parsed, functions) = read_tokens(input.tokens.clone(), &span::source_span);
    let (bodies, errors) = match parsed.check(&Registry::builtin()) {
        Ok(_) => (Bodies::Compiled, None),
        Err(diagnostics) => (Bodies::ForEditors, Some(errors::compile_errors(&diagnostics, &input.tokens))),
    };
    let module = parsed.draft.map(|draft| module_of(&input, &draft, &functions, bodies));
    quote! { #errors #module }
}

/// Returns the module of a description after a check of its grammar and types only; the registry is not used. `None` if
/// there is an error.
pub fn unchecked_fragment_buffer(input: TokenStream) -> Option<TokenStream> {
    let input = MacroInput::of_description(input);
    let (parsed, functions) = read_tokens(input.tokens.clone(), &span::source_span);
    let draft = parsed.draft.filter(|_| parsed.diagnostics.is_empty())?;
    Some(module_of(&input, &draft, &functions, Bodies::Compiled))
}

/// Returns a closure for the builder: `[$crate] |f| f.depth`.
pub fn closure(input: TokenStream) -> TokenStream {
    let input = MacroInput::of_function(input);
    let (serving, captured) = (&input.serving, captured(&input));
    quote! { #serving::builder::Closure::captured(#captured) }
}

/// Returns a helper function for the builder: `[$crate] fn name(x: f32) -> f32 { … }`.
pub fn function(input: TokenStream) -> TokenStream {
    let input = MacroInput::of_function(input);
    let (serving, captured) = (&input.serving, captured(&input));
    quote! { #serving::builder::Function::captured(#captured) }
}

fn module_of(input: &MacroInput, draft: &Draft, functions: &[FunctionTokens], bodies: Bodies) -> TokenStream {
    module::module(&ModuleSource { input, draft, functions, description: captured(input), bodies })
}

/// Returns the expression that gives the user's tokens to the running program.
fn captured(input: &MacroInput) -> TokenStream {
    let captured = CapturedTokens::from_tokens(&input.tokens, &span::source_span);
    let (file, text, places) = captured.parts();
    let serving = &input.serving;
    quote! { #serving::CapturedTokens::new(#file, #text, #places) }
}
