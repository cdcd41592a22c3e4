// Computes one colour from the k best of each pixel's fragments, which this pass selects: the storage kept all. Pixels
// without fragments keep the content of the target.

var<private> selected: array<Packed, CAPACITY>;
var<private> selected_count: u32;
/// The slot of the worst fragment, if k are selected.
var<private> worst_slot: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return vec4<f32>(0.0);
    }
    let pixel = pixel_index(position.xy);
    var cursor = storage_first(pixel);
    while cursor != END {
        select_fragment(pixel, storage_read(pixel, cursor));
        cursor = storage_next(pixel, cursor);
    }
    for (var slot = resolve_first(); slot != END; slot = resolve_next(slot)) {
        sort_gather(resolve_read(slot));
    }
    sort_finish();
    if sorted_count() == 0u {
        // If a pass serves only some pixels, the others have fragments but no layers.
        if overflow_is_empty(pixel) || resolve_first() != END {
            discard;
        }
        return overflow_finish(pixel, vec4<f32>(0.0));
    }
    return overflow_finish(pixel, samples_resolve());
}

fn resolve_first() -> u32 {
    return select(END, 0u, selected_count > 0u);
}

fn resolve_next(cursor: u32) -> u32 {
    return select(END, cursor + 1u, cursor + 1u < selected_count);
}

fn resolve_read(cursor: u32) -> Packed {
    return selected[cursor];
}

fn select_fragment(pixel: u32, entry: Packed) {
    if selected_count < frame.k {
        selected[selected_count] = entry;
        selected_count += 1u;
        if selected_count == frame.k {
            find_worst();
        }
        return;
    }
    if !better(entry, selected[worst_slot]) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    on_lost(pixel, selected[worst_slot], DISPLACED);
    selected[worst_slot] = entry;
    find_worst();
}

fn find_worst() {
    worst_slot = 0u;
    for (var slot = 1u; slot < selected_count; slot++) {
        if better(selected[worst_slot], selected[slot]) {
            worst_slot = slot;
        }
    }
}
