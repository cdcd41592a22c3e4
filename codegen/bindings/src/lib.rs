//! The macro that emits the module `bindings` of a description: the bind group's numbers, named as in the plan.
//!
//! Input: the tokens of a description. Output: a module of constants; nothing if the description has an error, because
//! `fragbuf::fragment_buffer!` reports it. A buffer is left out if its number depends on which alternative of an `else` a
//! target takes: the manifest and the bindings that build scripts write have a number per target.

use fragbuf_codegen::{Plan, plan};
use fragbuf_model::{Selection, SourceSpan, Variant};
use fragbuf_syntax::parse_tokens;
use fragbuf_templates::Registry;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Emits the module `bindings`; `fragbuf::fragment_buffer!` calls it.
#[proc_macro]
pub fn bindings(description: proc_macro::TokenStream) -> proc_macro::TokenStream {
    bindings_of(description.into()).into()
}

/// Returns the module for the tokens of a description.
fn bindings_of(description: TokenStream) -> TokenStream {
    let registry = Registry::builtin();
    // No diagnostic is shown, so every token may have the same span.
    let parsed = parse_tokens(description, &|_| SourceSpan::new("", 1, 1));
    parsed.check(&registry).map(|variant| bindings_module(&variant, &registry)).unwrap_or_default()
}

/// Uniform blocks that every target has: constant, binding and documentation.
const BLOCKS: [(&str, u32, &str); 2] = [
    ("FRAME", 0, "Size of the frame and the other values that the host sets for it."),
    ("CAMERA", 2, "The view-projection matrix of geometry passes."),
];

/// Returns the module for a variant.
fn bindings_module(variant: &Variant, registry: &Registry) -> TokenStream {
    let selections = [Selection::first(variant), Selection::last(variant)];
    let plans: Vec<Plan> = selections.iter().filter_map(|selection| plan(variant, selection, registry).ok()).collect();
    let Some((first, others)) = plans.split_first() else { return TokenStream::new() };
    let blocks = BLOCKS.iter().map(|(name, binding, summary)| constant(name, *binding, summary));
    let uniforms = (!variant.uniforms.is_empty()).then(|| constant("UNIFORMS", 1, "The uniforms of the description."));
    let in_every_plan = |name: &str, binding: u32| {
        let has = |plan: &Plan| plan.resources.iter().any(|p| p.resource.name == name && p.binding == binding);
        others.iter().all(has)
    };
    let buffers = first.resources.iter().filter(|planned| in_every_plan(&planned.resource.name, planned.binding)).map(
        |planned| {
            let summary = format!("`{}`: {}.", planned.resource.name, planned.resource.summary);
            constant(&planned.resource.name.to_ascii_uppercase(), planned.binding, &summary)
        },
    );
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::bindings_of;

    fn emitted(description: &str) -> String {
        bindings_of(description.parse().unwrap()).to_string()
    }

    /// `NAME = number`, for each constant.
    fn constants(description: &str) -> Vec<String> {
        let module = emitted(description);
        let constant = |text: &str| {
            let (name, rest) = text.split_once(" :").unwrap();
            let (_, number) = rest.split_once("= ").unwrap();
            format!("{name} = {}", number.split_once("u32").unwrap().0)
        };
        module.split("pub const ").skip(1).map(constant).collect()
    }

    #[test]
    fn buffers_are_numbered_from_3_on_in_the_order_of_the_rows() {
        let found = constants("buffer Bound from kplus_array { uniform { far: f32 } where |f, u| f.depth < u.far; }");
        let buffers = ["KEYS = 3", "ENTRIES = 4", "KEPT_COUNTS = 5", "LOCKS = 6", "COUNTERS = 7"];
        assert_eq!(found, [&["FRAME = 0", "CAMERA = 2", "UNIFORMS = 1"], &buffers[..]].concat());
    }

    /// The counters follow the locks, which only one of the alternatives has.
    #[test]
    fn buffers_whose_number_depends_on_the_target_are_left_out() {
        let found = constants("buffer Bound from kplus_array { sync: interlock else spin_lock; }");
        assert_eq!(found, ["FRAME = 0", "CAMERA = 2", "KEYS = 3", "ENTRIES = 4", "KEPT_COUNTS = 5"]);
    }

    #[test]
    fn a_description_with_a_mistake_has_no_bindings() {
        assert_eq!(emitted("buffer Bound from kplus_array { sort: insertoin; }"), "");
        assert_eq!(emitted("no description"), "");
    }
}
