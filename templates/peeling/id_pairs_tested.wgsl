// Peeling of fragments of equal depth by their ids, behind a depth test (Vasilakis & Fudos 2013, D13 sec. 3.1.2:
// F2B-3P). As id_pairs, but an iteration begins with a draw that does little: it writes the depth of the nearest
// fragment that is left. In the two draws that find the ids and store their fragments, an early depth test then
// rejects all fragments of other depths before they are shaded.
//
// The result does not rely on the depth test: the first draw also finds the key of the layer, and the others compare
// it.
//
// Invariant: the fragments composited so far are those of all layers before the last one, and those of the last one
// whose ids are not between the two of the window. The loop ends with an iteration that finds nothing. The last
// iteration that is allowed stores nothing: it counts the fragments that remain.
//
// Memory: 15 words per pixel, and one word.

/// The only side, and the slots of an iteration's fragments.
const PEELING_FRONT = 0u;
const PEELING_LEAST = 0u;
const PEELING_GREATEST = 1u;

fn peeling_find(pixel: u32, entry: Packed) {
    if FIND_IDS == 0u {
        peeling_find_layer(pixel, entry.key);
        return;
    }
    if peeling_is_in_layer(pixel, entry) {
        id_pairs_find(PEELING_FRONT, pixel, id_pairs_id(entry));
    }
}

/// Finds the key of the nearest fragments that are left.
fn peeling_find_layer(pixel: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    id_pairs_find_next(PEELING_FRONT, pixel, key);
}

fn peeling_is_left(pixel: u32, entry: Packed) -> bool {
    let last = window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    let id = id_pairs_id(entry);
    return last == EMPTY || entry.key > last
        || (entry.key == last && id > window_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel)
            && ~id > window_load(ID_PAIRS_GREATEST, PEELING_FRONT, pixel));
}

fn peeling_is_in_layer(pixel: u32, entry: Packed) -> bool {
    return entry.key == found_load(ID_PAIRS_NEXT, PEELING_FRONT, pixel) && peeling_is_left(pixel, entry);
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    return !peeling_takes(pixel_index(position), fragment_pack(fragment));
}

/// Returns whether this iteration stores a fragment.
fn peeling_takes(pixel: u32, entry: Packed) -> bool {
    return peeling_is_in_layer(pixel, entry) && id_pairs_takes(PEELING_FRONT, pixel, id_pairs_id(entry));
}

/// The draw that finds the layer counts fragments.
fn peeling_is_first(position: vec2<f32>) -> bool {
    return false;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    return peeling_takes(pixel_index(position), fragment_pack(fragment));
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    let is_least = id_pairs_id(entry) == found_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel);
    return select(PEELING_GREATEST, PEELING_LEAST, is_least);
}

fn peeling_begin(slot: u32) {
    accumulated_slot = slot;
    let layer = found_load(ID_PAIRS_NEXT, PEELING_FRONT, accumulated_pixel);
    if slot == PEELING_LEAST && layer != window_load(ID_PAIRS_KEY, PEELING_FRONT, accumulated_pixel) {
        // The last layer has ended.
        accumulated_join(PEELING_LEAST, PEELING_GREATEST, accumulated_pixel);
    }
}

fn peeling_advance() {
    let layer = found_load(ID_PAIRS_NEXT, PEELING_FRONT, accumulated_pixel);
    if layer == EMPTY {
        return;
    }
    window_store(ID_PAIRS_KEY, PEELING_FRONT, accumulated_pixel, layer);
    for (var word = ID_PAIRS_LEAST; word <= ID_PAIRS_GREATEST; word++) {
        window_store(word, PEELING_FRONT, accumulated_pixel, found_load(word, PEELING_FRONT, accumulated_pixel));
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    return window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
}
