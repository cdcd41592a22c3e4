//! The functions by which rows of different axes call each other. A template implements a contract with functions of these names and
//! exactly these signatures; its other declarations are private.

/// One function of a contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contract {
    /// The axis whose rows implement it.
    pub axis: &'static str,
    /// The name of the function.
    pub name: &'static str,
    /// Its parameters and result, as WGSL.
    pub signature: &'static str,
    /// The behaviour, beginning with a verb. It follows the signature in help texts.
    pub behaviour: &'static str,
}

/// Every contract. A storage provides those that its passes call: `storage_count` only if a pass counts.
pub const CONTRACTS: &[Contract] = &[
    row("storage", "storage_reset", "(pixel: u32)", "resets the pixel to its empty state"),
    row("storage", "storage_count", "(pixel: u32)", "counts a fragment that a later pass will store"),
    row(
        "storage",
        "storage_size",
        "(pixel: u32) -> u32",
        "returns how many entries the pixel needs, after its fragments have been counted",
    ),
    row(
        "storage",
        "storage_reserve",
        "(pixel: u32, entry: Packed) -> bool",
        "stores, outside any lock, a fragment that reserves its own slot, or passes it to on_lost; returns false if it must be inserted",
    ),
    row(
        "storage",
        "storage_fragments",
        "(pixel: u32) -> u32",
        "returns how many fragments of the pixel have been counted",
    ),
    row("allocation", "allocation_count", "(pixel: u32)", "counts a fragment that a later pass will store"),
    row(
        "allocation",
        "allocation_fragments",
        "(pixel: u32) -> u32",
        "returns how many fragments of the pixel were counted",
    ),
    row("allocation", "allocation_slots", "(pixel: u32) -> u32", "returns how many fragments the pixel keeps at most"),
    row("allocation", "allocation_level", "(pixel: u32) -> u32", "returns the importance of the pixel, from 0 to 255"),
    row("storage", "storage_prepass", "(pixel: u32, entry: Packed)", "records a fragment that a later pass will store"),
    row("storage", "storage_insert", "(pixel: u32, entry: Packed)", "stores a fragment, or passes one to on_lost"),
    row("storage", "storage_refine", "(pixel: u32, entry: Packed)", "writes further words of a stored fragment"),
    row(
        "storage",
        "storage_bound",
        "(pixel: u32) -> u32",
        "returns, at any instant, a key that none of the final k best fragments exceeds",
    ),
    row(
        "storage",
        "storage_worst",
        "(pixel: u32) -> u32",
        "returns, inside the critical section, the cursor of the worst of k kept fragments",
    ),
    row(
        "storage",
        "storage_replace",
        "(pixel: u32, cursor: u32, entry: Packed)",
        "replaces, inside the critical section, a kept entry by another; the caller ensures that the keys stay in order",
    ),
    row("storage", "storage_first", "(pixel: u32) -> u32", "returns the cursor of the first fragment, or END"),
    row("storage", "storage_next", "(pixel: u32, cursor: u32) -> u32", "returns the cursor after this one, or END"),
    row("storage", "storage_read", "(pixel: u32, cursor: u32) -> Packed", "returns the fragment at a cursor"),
    row(
        "storage",
        "storage_streamed",
        "(pixel: u32) -> vec4<f32>",
        "returns the premultiplied colour of the fragments that have left the pixel",
    ),
    row(
        "sync",
        "sync_store",
        "(pixel: u32, entry: Packed)",
        "calls storage_insert, synchronised as the row declares, or on_lost",
    ),
    row("cull", "cull_fragment", "(pixel: u32, entry: Packed) -> bool", "returns whether the fragment is culled"),
    row(
        "opaque",
        "opaque_hides",
        "(position: vec2<f32>, fragment: Fragment) -> bool",
        "returns whether an opaque surface hides the fragment; `position` is that of the fragment, in pixels",
    ),
    row(
        "overflow",
        "on_lost",
        "(pixel: u32, lost: Packed, reason: u32)",
        "handles a fragment that is lost; `reason` is a counter",
    ),
    row("overflow", "on_culled", "(pixel: u32, lost: Packed)", "handles a fragment that is culled"),
    row(
        "overflow",
        "overflow_is_empty",
        "(pixel: u32) -> bool",
        "returns whether a pixel without kept fragments shows nothing",
    ),
    row(
        "overflow",
        "overflow_finish",
        "(pixel: u32, color: vec4<f32>) -> vec4<f32>",
        "returns the premultiplied colour of the pixel, from the colour of its kept fragments",
    ),
    row(
        "cull",
        "cull_key_range",
        "(pixel: u32, entry: Packed)",
        "extends the range of the pixel's keys to include a fragment",
    ),
    row(
        "cull",
        "cull_occupancy_map",
        "(pixel: u32, entry: Packed)",
        "marks the position of a fragment in the range of the pixel's keys",
    ),
    row(
        "cull",
        "cull_occupancy_bound",
        "(pixel: u32)",
        "reduces the range of the pixel's keys to those that can be kept",
    ),
    row("cull", "cull_last", "(pixel: u32) -> u32", "returns the last key that can be kept"),
    row(
        "addressing",
        "pixel_index",
        "(position: vec2<f32>) -> u32",
        "returns the number of the pixel, below pixel_count()",
    ),
    row("addressing", "pixel_texel", "(pixel: u32) -> vec2<u32>", "returns the texel of a pixel in textures"),
    row("addressing", "pixel_count", "() -> u32", "returns the number of pixels of the frame, with padding"),
    row("counters", "count_event", "(counter: u32)", "counts an event that is not a loss"),
    row("counters", "count_loss", "(counter: u32)", "counts a loss"),
    row("counters", "count_losses", "(counter: u32, number: u32)", "counts any number of losses"),
    row(
        "peeling",
        "peeling_find_first",
        "(pixel: u32, key: u32)",
        "lowers the key of the pixel's first layer to that of a fragment",
    ),
    row(
        "peeling",
        "peeling_skips",
        "(position: vec2<f32>, fragment: Fragment) -> bool",
        "returns whether this iteration leaves the fragment to another; `position` is that of the fragment, in pixels",
    ),
    row(
        "peeling",
        "peeling_admits",
        "(position: vec2<f32>, fragment: Fragment) -> bool",
        "returns whether this iteration stores the fragment, and records it if another does; called once per fragment and iteration",
    ),
    row(
        "peeling",
        "peeling_is_first",
        "(position: vec2<f32>) -> bool",
        "returns whether this is the first iteration that draws the scene",
    ),
    row(
        "peeling",
        "peeling_find",
        "(pixel: u32, entry: Packed)",
        "records a fragment before this iteration stores any, to find those that it stores",
    ),
    row(
        "peeling",
        "peeling_is_left",
        "(pixel: u32, entry: Packed) -> bool",
        "returns whether no earlier iteration has stored the fragment",
    ),
    row(
        "peeling",
        "peeling_slot",
        "(pixel: u32, entry: Packed) -> u32",
        "returns the slot of a fragment that this iteration stores, below PEELING_SLOTS; the fragments of a slot have equal keys",
    ),
    row("peeling", "peeling_begin", "(slot: u32)", "begins to continue the effect with the fragments of a slot"),
    row("peeling", "peeling_resume", "(pixel: u32)", "begins to resolve the pixel"),
    row(
        "peeling",
        "peeling_advance",
        "()",
        "ends it: what has been read is kept, and an iteration with the rest may follow",
    ),
    row(
        "peeling",
        "peeling_reached",
        "(pixel: u32) -> u32",
        "returns, after an iteration, a key that no fragment is less than which no iteration has stored; EMPTY if none is left",
    ),
    row(
        "peeling",
        "peeling_layer_count",
        "(sorted: u32) -> u32",
        "returns the number of fragments that an effect reads, from the number of sorted ones",
    ),
    row("peeling", "peeling_is_copy", "(index: u32) -> bool", "returns whether a layer is a copy of the boundary"),
    row("peeling", "peeling_copy", "() -> Packed", "returns the fragment at the boundary"),
    row(
        "peeling",
        "peeling_sorted_index",
        "(index: u32) -> u32",
        "returns the index of a layer among the sorted fragments",
    ),
    row(
        "peeling",
        "peeling_color",
        "(transparent: vec3<f32>) -> vec3<f32>",
        "returns the premultiplied colour of the fragments of earlier iterations; the argument if there are none",
    ),
    row(
        "peeling",
        "peeling_transmittance",
        "() -> f32",
        "returns how much light passes the fragments of earlier iterations; 1 if there are none",
    ),
    row(
        "peeling",
        "peeling_suspend",
        "(color: vec3<f32>, transmittance: f32)",
        "saves both, for the fragments of the next iteration",
    ),
    row(
        "peeling",
        "peeling_layer",
        "(index: u32) -> u32",
        "returns the number of the layer of a fragment that an effect reads: its place, or that of what the iteration stores",
    ),
    row("peeling", "peeling_result", "(pixel: u32) -> vec4<f32>", "returns the premultiplied colour of the pixel"),
    row("peeling", "peeling_pixel", "() -> u32", "returns the pixel that is resolved"),
    row(
        "peeling",
        "peeling_word",
        "(word: u32, pixel: u32) -> u32",
        "returns a word that the effect has saved in an earlier iteration, of those of the formula `resumed_words`; 0 in the first",
    ),
    row(
        "peeling",
        "peeling_save",
        "(word: u32, pixel: u32, value: u32)",
        "saves a word of the effect for the next iteration",
    ),
    row("sort", "sort_begin", "()", "forgets the fragments that were added"),
    row("sort", "sort_gather", "(entry: Packed)", "adds one fragment of the pixel"),
    row("sort", "sort_finish", "()", "sorts the fragments, nearest first"),
    row(
        "sort",
        "sorted_count",
        "() -> u32",
        "returns the number of sorted fragments; if it is 0, the pixel of the target does not change",
    ),
    row(
        "sort",
        "sorted_layer",
        "(index: u32) -> Fragment",
        "returns a fragment, the nearest first; an index beyond the last returns the last",
    ),
    row("samples", "layer_count", "() -> u32", "returns the number of fragments that an effect reads, at least one"),
    row(
        "samples",
        "layer",
        "(index: u32) -> Fragment",
        "returns a fragment, the nearest first; an index beyond the last returns the last",
    ),
    row(
        "samples",
        "samples_resolve",
        "() -> vec4<f32>",
        "returns the premultiplied colour of the pixel, from the results of the effect for its samples",
    ),
    row(
        "samples",
        "samples_share",
        "(entry: Packed) -> f32",
        "returns the share of the pixel that a fragment covers, above 0 and at most 1",
    ),
    row(
        "pass",
        "resolve_first",
        "() -> u32",
        "returns the cursor of the first fragment of the pixel that is resolved, or END",
    ),
    row("pass", "resolve_next", "(cursor: u32) -> u32", "returns the cursor after this one, or END"),
    row(
        "pass",
        "resolve_read",
        "(cursor: u32) -> Packed",
        "returns the fragment at a cursor; may be called several times",
    ),
    row(
        "resolve",
        "resolve_layers",
        "() -> vec4<f32>",
        "returns a premultiplied colour from the fragments that `layer` returns; called if there is at least one",
    ),
    row(
        "resolve",
        "resolve_result",
        "(pixel: u32) -> vec4<f32>",
        "returns the premultiplied colour of the pixel after the last iteration of peeling",
    ),
    row(
        "resolve",
        "stream_value",
        "(front: Fragment, back: Fragment, gap: f32) -> vec4<f32>",
        "returns the premultiplied colour from a fragment to the next, `gap` behind it in depth; the last is its own next",
    ),
];

/// The functions that the headers of templates describe after their first paragraph. The first paragraph describes the whole file.
pub(crate) const DESCRIBED: [&str; 3] = ["storage_insert", "cull_fragment", "on_lost"];

const fn row(axis: &'static str, name: &'static str, signature: &'static str, behaviour: &'static str) -> Contract {
    Contract { axis, name, signature, behaviour }
}
