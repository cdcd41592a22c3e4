// k-depth peeling (K15 sec. 4.3) over a k-buffer that keeps its best. The scene is drawn again and again. An iteration
// stores the k best of the fragments that no earlier one has kept, and the effect goes on where it stopped. So every
// fragment is composited, with the memory of k.
//
// The boundary of a pixel is the worst fragment kept so far, with all its words. A fragment enters if it is worse:
// fragments of equal depth are told apart by their other words. Only exact copies of the boundary cannot be, and need
// not be: an iteration counts those that it meets, and the effect composites the boundary as many times more than it
// has been kept.
//
// Invariant: the fragments composited so far are the best of the pixel, each as often as it was drawn. The first
// iteration counts all fragments, so the loop ends with the iteration that composites the last one: after at most
// ceil(n / k) iterations for n fragments in the deepest pixel. The last iteration that is allowed counts what remains
// as lost. A fragment that timed out at a lock or did not fit in a pool may still be kept by a later iteration.
//
// Memory: entry_words + 6 words per pixel, and one word.

/// Parts of `unpeeled`: fragments of the pixel that no iteration has kept, and copies of the boundary that this
/// iteration has met beyond those that are kept.
const PEELING_LEFT = 0u;
const PEELING_COPIES = 1u;

/// How often the effect composites the boundary again.
var<private> peeling_copies: u32;

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    let last = boundary_load(pixel_index(position));
    return last.key != EMPTY && !better(last, fragment_pack(fragment));
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return boundary_load(pixel_index(position)).key == EMPTY;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let pixel = pixel_index(position);
    let last = boundary_load(pixel);
    if last.key == EMPTY {
        unpeeled_atomic_add(PEELING_LEFT, pixel, 1u);
        return true;
    }
    if unpeeled_load(PEELING_LEFT, pixel) == 0u {
        return false;
    }
    let entry = fragment_pack(fragment);
    if better(last, entry) {
        return true;
    }
    if !better(entry, last) {
        unpeeled_atomic_add(PEELING_COPIES, pixel, 1u);
    }
    return false;
}

fn peeling_resume(pixel: u32) {
    accumulated_pixel = pixel;
    // As many as all iterations could keep: no loop relies on memory for its end.
    peeling_copies = min(peeling_copies_met(pixel), PEELING_ITERATIONS * frame.k);
}

fn peeling_copies_met(pixel: u32) -> u32 {
    // The copies that were kept have been subtracted before this iteration counted all.
    return u32(max(bitcast<i32>(unpeeled_load(PEELING_COPIES, pixel)), 0));
}

fn peeling_layer_count(sorted: u32) -> u32 {
    return peeling_copies + sorted;
}

fn peeling_is_copy(index: u32) -> bool {
    return index < peeling_copies;
}

fn peeling_copy() -> Packed {
    return boundary_load(accumulated_pixel);
}

fn peeling_sorted_index(index: u32) -> u32 {
    return index - peeling_copies;
}

fn peeling_advance() {
    let pixel = accumulated_pixel;
    var last = boundary_load(pixel);
    if last.key == EMPTY {
        // From now on, no fragment of the pixel is in its first iteration.
        last = packed_of_key(0u);
    }
    var kept = 0u;
    var copies = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        let entry = resolve_read(cursor);
        if better(last, entry) {
            last = entry;
            copies = 1u;
        } else if !better(entry, last) {
            copies += 1u;
        }
        kept += 1u;
    }
    let met = peeling_copies_met(pixel);
    count_losses(NOT_CONVERGED, met - peeling_copies);
    boundary_store(pixel, last);
    unpeeled_store(PEELING_COPIES, pixel, 0u - copies);
    let before = unpeeled_load(PEELING_LEFT, pixel);
    let done = met + kept;
    // Where fragments have been lost, some of those counted are never found.
    if kept == 0u || done >= before {
        unpeeled_store(PEELING_LEFT, pixel, 0u);
        return;
    }
    unpeeled_store(PEELING_LEFT, pixel, before - done);
    remaining_store(1u);
    if frame.iteration + 1u == PEELING_ITERATIONS {
        count_losses(NOT_CONVERGED, before - done);
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    if unpeeled_load(PEELING_LEFT, pixel) == 0u {
        return EMPTY;
    }
    return boundary_load(pixel).key;
}
