// Peeling of layers, and of fragments of equal depth by their ids where there are any: the hybrid that D13 proposes
// (Vasilakis & Fudos 2013, sec. 5). An iteration is one draw. In a new layer it stores the first fragment that arrives,
// and finds the least and the greatest id. If that was the only fragment, the layer has ended. Otherwise what was
// stored is not read, and the next iterations store the fragments of two ids each, from both ends, until none is left.
// So a layer of one fragment takes one draw, and a layer of c fragments 1 + ceil(c / 2), where `id_pairs` takes 2
// ceil(c / 2). Every pixel decides for itself.
//
// The fragments with the greater ids of a layer are composited apart, as in `id_pairs`: the image is that of an
// A-buffer with the same ties.
//
// Invariant: the fragments composited so far are those of all layers before the present one, and those of the present
// layer whose ids are neither in nor between those of the window. A fragment that arrives first is composited only if
// no other has the key of its layer, so the order of fragments has no effect. Fragments with equal ids are stored in
// the same iteration.
//
// Memory: 16 words per pixel, and one word.

/// The only side, and the slots of an iteration's fragments.
const PEELING_FRONT = 0u;
const PEELING_LEAST = 0u;
const PEELING_GREATEST = 1u;

/// The word of `found` that the first fragment of a new layer takes.
const PEELING_TAKEN = 4u;

fn peeling_find_first(pixel: u32, key: u32) {
    // Most fragments are behind another one: reading is cheaper than a minimum that changes nothing.
    if key < window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) {
        window_atomic_min(ID_PAIRS_KEY, PEELING_FRONT, pixel, key);
    }
}

/// Returns whether the ids of the pixel's layer are unknown. The least id may be EMPTY, but then the greatest is not.
fn peeling_is_new(pixel: u32) -> bool {
    return window_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel) == EMPTY
        && window_load(ID_PAIRS_GREATEST, PEELING_FRONT, pixel) == EMPTY;
}

/// Returns whether this iteration stores the fragments of an id of the pixel's layer.
fn peeling_takes(pixel: u32, id: u32) -> bool {
    let greatest = window_load(ID_PAIRS_GREATEST, PEELING_FRONT, pixel);
    return id == window_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel) || ~id == greatest;
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let entry = fragment_pack(fragment);
    let pixel = pixel_index(position);
    let id = id_pairs_id(entry);
    let layer = window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    if entry.key > layer {
        peeling_find_next(pixel, entry.key);
        return false;
    }
    if entry.key != layer {
        return false;
    }
    if peeling_is_new(pixel) {
        id_pairs_find(PEELING_FRONT, pixel, id);
        if found_atomic_min(PEELING_TAKEN, PEELING_FRONT, pixel, 0u) == EMPTY {
            return true;
        }
        id_pairs_leave(PEELING_FRONT, pixel);
        return false;
    }
    if peeling_takes(pixel, id) {
        return true;
    }
    if id_pairs_is_left(PEELING_FRONT, pixel, id) {
        id_pairs_find(PEELING_FRONT, pixel, id);
        id_pairs_leave(PEELING_FRONT, pixel);
    }
    return false;
}

fn peeling_find_next(pixel: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    id_pairs_find_next(PEELING_FRONT, pixel, key);
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    let is_least = id_pairs_id(entry) == window_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel);
    return select(PEELING_GREATEST, PEELING_LEAST, is_least || peeling_is_new(pixel));
}

fn peeling_layer_count(sorted: u32) -> u32 {
    // The first fragment of a layer that has others comes again, in the order of ids.
    return select(sorted, 0u, peeling_is_new(accumulated_pixel) && peeling_has_others(accumulated_pixel));
}

/// Returns whether the iteration has met fragments of the layer that it has not stored.
fn peeling_has_others(pixel: u32) -> bool {
    return found_load(ID_PAIRS_BETWEEN, PEELING_FRONT, pixel) == 0u;
}

fn peeling_advance() {
    let pixel = accumulated_pixel;
    if window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) == EMPTY {
        // The pixel has no layer left.
        return;
    }
    if peeling_has_others(pixel) {
        window_store(ID_PAIRS_LEAST, PEELING_FRONT, pixel, found_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel));
        window_store(ID_PAIRS_GREATEST, PEELING_FRONT, pixel, found_load(ID_PAIRS_GREATEST, PEELING_FRONT, pixel));
        return;
    }
    if !peeling_is_new(pixel) {
        accumulated_join(PEELING_LEAST, PEELING_GREATEST, pixel);
    }
    window_store(ID_PAIRS_KEY, PEELING_FRONT, pixel, found_load(ID_PAIRS_NEXT, PEELING_FRONT, pixel));
    window_store(ID_PAIRS_LEAST, PEELING_FRONT, pixel, EMPTY);
    window_store(ID_PAIRS_GREATEST, PEELING_FRONT, pixel, EMPTY);
}

fn peeling_reached(pixel: u32) -> u32 {
    return window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
}
