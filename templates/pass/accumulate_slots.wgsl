// Goes on with the effect of each pixel, as `accumulate`, slot by slot: the fragments of each slot continue what the
// peeling has accumulated for it.

/// The index of the pixel.
var<private> resolved: u32;
/// The slot whose fragments are read.
var<private> resolved_slot: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return;
    }
    resolved = pixel_index(position.xy);
    peeling_resume(resolved);
    for (var slot = 0u; slot < PEELING_SLOTS; slot++) {
        accumulate_slots_continue(slot);
    }
    peeling_advance();
}

fn accumulate_slots_continue(slot: u32) {
    resolved_slot = slot;
    peeling_begin(slot);
    sort_begin();
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        sort_gather(resolve_read(cursor));
    }
    sort_finish();
    if peeling_layer_count(sorted_count()) > 0u {
        samples_resolve();
    }
}

fn resolve_first() -> u32 {
    return accumulate_slots_seek(storage_first(resolved));
}

fn resolve_next(cursor: u32) -> u32 {
    return accumulate_slots_seek(storage_next(resolved, cursor));
}

fn resolve_read(cursor: u32) -> Packed {
    return storage_read(resolved, cursor);
}

/// Returns the first cursor from `start` on whose fragment is in the slot.
fn accumulate_slots_seek(start: u32) -> u32 {
    var cursor = start;
    while cursor != END {
        if peeling_slot(resolved, storage_read(resolved, cursor)) == resolved_slot {
            return cursor;
        }
        cursor = storage_next(resolved, cursor);
    }
    return END;
}
