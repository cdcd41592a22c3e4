// Computes an image of the description from the k best of each pixel's fragments, which this pass selects: the storage
// kept all. The pass of the effect counts the others. Pixels without fragments have the value 0.

/// The best fragments so far, best first.
var<private> selected: array<Packed, CAPACITY>;
var<private> selected_count: u32;
/// The index of the pixel.
var<private> resolved: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) {
    if !is_in_frame(position.xy) {
        // A helper invocation: it has no pixel.
        return;
    }
    resolved = pixel_index(position.xy);
    var cursor = storage_first(resolved);
    while cursor != END {
        select_fragment(storage_read(resolved, cursor));
        cursor = storage_next(resolved, cursor);
    }
    for (var slot = resolve_first(); slot != END; slot = resolve_next(slot)) {
        sort_gather(resolve_read(slot));
    }
    sort_finish();
    if sorted_count() == 0u {
        image_store(resolved, vec4<f32>(0.0));
        return;
    }
    image_store(resolved, samples_resolve());
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

/// Inserts a fragment in order. The worst of more than k is lost.
fn select_fragment(entry: Packed) {
    if selected_count == frame.k {
        let worst = selected[frame.k - 1u];
        if !better(entry, worst) {
            return;
        }
    } else {
        selected_count += 1u;
    }
    var slot = selected_count - 1u;
    while slot > 0u && better(entry, selected[slot - 1u]) {
        selected[slot] = selected[slot - 1u];
        slot -= 1u;
    }
    selected[slot] = entry;
}
