//! The functions through which the axes meet. A template fulfils a contract by offering functions of these names with
//! exactly these heads; everything else in it is private.

use fragbuf_templates::Registry;

use crate::link::{Head, heads};

/// One function of a contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contract {
    /// The axis whose rows fulfil it.
    pub axis: &'static str,
    /// The function.
    pub name: &'static str,
    /// Its parameters and result, as WGSL.
    pub signature: &'static str,
    /// What it promises.
    pub promise: &'static str,
}

/// Every contract. A storage offers those that its passes call: `storage_count` only where a pass counts.
pub const CONTRACTS: &[Contract] = &[
    row("storage", "storage_reset", "(pixel: u32)", "brings the pixel to its empty state"),
    row("storage", "storage_count", "(pixel: u32)", "counts a fragment that a later pass will store"),
    row(
        "storage",
        "storage_size",
        "(pixel: u32) -> u32",
        "entries that the pixel needs room for, once it has been counted",
    ),
    row(
        "storage",
        "storage_reserve",
        "(pixel: u32, entry: Packed) -> bool",
        "outside any lock: stores a fragment that has a place of its own, or hands it to on_lost; false: insert it",
    ),
    row(
        "storage",
        "storage_survey",
        "(pixel: u32, entry: Packed)",
        "learns of a fragment that a later pass will store",
    ),
    row("storage", "storage_insert", "(pixel: u32, entry: Packed)", "stores a fragment or hands one to on_lost"),
    row("storage", "storage_settle", "(pixel: u32, entry: Packed)", "settles more of a fragment that was stored"),
    row(
        "storage",
        "storage_bound",
        "(pixel: u32) -> u32",
        "a key that no fragment of the final k best exceeds, at any instant",
    ),
    row(
        "storage",
        "storage_worst",
        "(pixel: u32) -> u32",
        "inside the critical section: the cursor of the worst of k kept fragments",
    ),
    row(
        "storage",
        "storage_replace",
        "(pixel: u32, cursor: u32, entry: Packed)",
        "inside the critical section: puts an entry in place of a kept one; the caller keeps keys where they belong",
    ),
    row("storage", "storage_first", "(pixel: u32) -> u32", "the cursor of a first fragment, or END"),
    row("storage", "storage_next", "(pixel: u32, cursor: u32) -> u32", "the cursor after this one, or END"),
    row("storage", "storage_read", "(pixel: u32, cursor: u32) -> Packed", "the fragment at a cursor"),
    row(
        "storage",
        "storage_streamed",
        "(pixel: u32) -> vec4<f32>",
        "the premultiplied colour of the fragments that have left the pixel",
    ),
    row("sync", "sync_store", "(pixel: u32, entry: Packed)", "calls storage_insert as the sync promises, or on_lost"),
    row("cull", "cull_fragment", "(pixel: u32, entry: Packed) -> bool", "whether the fragment is turned away"),
    row(
        "opaque",
        "opaque_hides",
        "(position: vec2<f32>, fragment: Fragment) -> bool",
        "whether an opaque surface hides the fragment; `position` is the fragment's, in pixels",
    ),
    row(
        "overflow",
        "on_lost",
        "(pixel: u32, lost: Packed, reason: u32)",
        "disposes of a fragment that finds no place; `reason` is a counter",
    ),
    row("overflow", "on_culled", "(pixel: u32, lost: Packed)", "disposes of a fragment that was turned away"),
    row("overflow", "overflow_is_empty", "(pixel: u32) -> bool", "whether a pixel that kept nothing shows nothing"),
    row(
        "overflow",
        "overflow_finish",
        "(pixel: u32, color: vec4<f32>) -> vec4<f32>",
        "the pixel's premultiplied colour, once that of its kept fragments is known",
    ),
    row("cull", "cull_measure", "(pixel: u32, entry: Packed)", "takes a fragment into the range of the pixel's keys"),
    row("cull", "cull_occupy", "(pixel: u32, entry: Packed)", "marks where in that range a fragment lies"),
    row("cull", "cull_narrow", "(pixel: u32)", "narrows that range to the keys that may stay"),
    row("cull", "cull_last", "(pixel: u32) -> u32", "the last key that may stay"),
    row("addressing", "pixel_index", "(position: vec2<f32>) -> u32", "the pixel's number, below pixel_count()"),
    row("addressing", "pixel_texel", "(pixel: u32) -> vec2<u32>", "the texel of a pixel's number in textures"),
    row("addressing", "pixel_count", "() -> u32", "pixels of the frame"),
    row("counters", "count_event", "(counter: u32)", "counts what is no loss"),
    row("counters", "count_loss", "(counter: u32)", "counts a loss"),
    row("counters", "count_losses", "(counter: u32, number: u32)", "counts several losses at once, or none"),
    row("sort", "sort_gather", "(entry: Packed)", "takes one fragment of the pixel"),
    row("sort", "sort_finish", "()", "puts the fragments in order, nearest first"),
    row("sort", "sorted_count", "() -> u32", "fragments in order; 0: the pixel keeps what the target held"),
    row("sort", "sorted_layer", "(index: u32) -> Fragment", "one of them, the nearest first; the last beyond the last"),
    row("samples", "layer_count", "() -> u32", "fragments that an effect sees, at least one"),
    row("samples", "layer", "(index: u32) -> Fragment", "one of them, the nearest first; the last beyond the last"),
    row(
        "samples",
        "samples_resolve",
        "() -> vec4<f32>",
        "the pixel's premultiplied colour, by what effects make of its samples",
    ),
    row(
        "samples",
        "samples_share",
        "(entry: Packed) -> f32",
        "how much of its pixel a fragment covers, above 0, 1: all",
    ),
    row("pass", "resolve_first", "() -> u32", "the cursor of a first fragment of the pixel that is resolved, or END"),
    row("pass", "resolve_next", "(cursor: u32) -> u32", "the cursor after this one, or END"),
    row("pass", "resolve_read", "(cursor: u32) -> Packed", "the fragment at a cursor; any number of times"),
    row(
        "resolve",
        "resolve_layers",
        "() -> vec4<f32>",
        "a premultiplied colour from what `layer` gives; called if there is at least one",
    ),
    row(
        "resolve",
        "stream_value",
        "(front: Fragment, back: Fragment, gap: f32) -> vec4<f32>",
        "a premultiplied colour from one fragment to the next, `gap` in depth behind it; the last is its own next",
    ),
];

/// What the heads of templates describe after their first paragraph, which holds for every part of the file.
pub(crate) const DESCRIBED: [&str; 3] = ["storage_insert", "cull_fragment", "on_lost"];

const fn row(axis: &'static str, name: &'static str, signature: &'static str, promise: &'static str) -> Contract {
    Contract { axis, name, signature, promise }
}

/// Where a template's function has the name of a contract and another head; empty when all is well.
pub fn verify(registry: &Registry) -> Vec<String> {
    let mut faults = Vec::new();
    for row in registry.rows() {
        let Some(template) = &row.template else { continue };
        let heads = heads(&template.text);
        for contract in CONTRACTS {
            for Head { name, signature, .. } in &heads {
                if *name == contract.name && (row.axis != contract.axis || *signature != contract.signature) {
                    faults.push(format!(
                        "{}: `fn {name}{signature}` should be `fn {name}{}`",
                        template.path, contract.signature
                    ));
                }
            }
        }
        let offers_any = CONTRACTS.iter().any(|contract| heads.iter().any(|head| head.name == contract.name));
        let is_chosen = registry.axis(&row.axis).is_some_and(|axis| axis.chosen);
        if is_chosen && !offers_any && CONTRACTS.iter().any(|contract| contract.axis == row.axis) {
            faults.push(format!("{}: offers no function of the contract `{}`", template.path, row.axis));
        }
    }
    faults
}
