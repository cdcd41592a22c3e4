//! Where the passes of a description find what they are bound to: numbers in the bind group, by the names of the plan.
//!
//! In: a variant. Out: a module of constants. Buffers whose number depends on which alternative of an `else` a target takes
//! are left out: for those there are a generation's manifest and the bindings that build scripts write.

use fragbuf_codegen::{Plan, plan};
use fragbuf_model::{Selection, Variant};
use fragbuf_templates::Registry;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Bindings before those of buffers, as every target has them.
const BLOCKS: [(&str, u32, &str); 2] = [
    ("FRAME", 0, "Size of the frame and what else the host sets for it."),
    ("CAMERA", 2, "The view-projection matrix of geometry passes."),
];

/// The module `bindings`.
pub(crate) fn module(variant: &Variant, registry: &Registry) -> TokenStream {
    let picks = [Selection::first(variant), Selection::last(variant)];
    let plans: Vec<Plan> = picks.iter().filter_map(|selection| plan(variant, selection, registry).ok()).collect();
    let Some((first, others)) = plans.split_first() else { return TokenStream::new() };
    let blocks = BLOCKS.iter().map(|(name, binding, summary)| constant(name, *binding, summary));
    let uniforms = (!variant.uniforms.is_empty()).then(|| constant("UNIFORMS", 1, "The description's own uniforms."));
    let same = |name: &str, binding: u32| {
        let bound = |plan: &Plan| plan.resources.iter().any(|p| p.resource.name == name && p.binding == binding);
        others.iter().all(bound)
    };
    let buffers =
        first.resources.iter().filter(|planned| same(&planned.resource.name, planned.binding)).map(|planned| {
            let summary = format!("`{}`: {}.", planned.resource.name, planned.resource.summary);
            constant(&planned.resource.name.to_ascii_uppercase(), planned.binding, &summary)
        });
    quote! {
        /// Bindings in the bind group that the passes are generated with.
        pub mod bindings {
            #(#blocks)*
            #uniforms
            #(#buffers)*
        }
    }
}

fn constant(name: &str, binding: u32, summary: &str) -> TokenStream {
    let name = format_ident!("{name}");
    quote! {
        #[doc = #summary]
        pub const #name: ::core::primitive::u32 = #binding;
    }
}
