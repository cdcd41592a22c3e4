// Peeling of fragments of equal depth by their ids (Vasilakis & Fudos 2013, D13 sec. 3.1.2, Alg. 1: F2B-2P). An
// iteration stores the fragments of the nearest layer with the least and the greatest id of those left in it, so c
// fragments of equal depth take ceil(c / 2) iterations of two draws. The id is the first word that decides ties: with
// `ties: attribute { by: id }`, the attribute. The first draw of an iteration finds the ids, the second stores their
// fragments, and finds whether ids are left between them, and the next layer.
//
// The paper composites the two fragments next to each other. Here the fragments with the greater ids of a layer are
// composited apart, each over those before it, and join the others when the layer ends: so the image is that of an
// A-buffer with the same ties. Ids are integers in buffers, not floats in render targets: none is too great.
//
// Invariant: the fragments composited so far are those of all layers before the present one, and those of the present
// layer whose ids are not between the two of the window. What passes find is read in later passes, so the order of
// fragments has no effect. Fragments with equal ids are stored in the same iteration.
//
// Memory: 15 words per pixel, and one word.

/// The only side, and the slots of an iteration's fragments.
const PEELING_FRONT = 0u;
const PEELING_LEAST = 0u;
const PEELING_GREATEST = 1u;

fn peeling_find_first(pixel: u32, key: u32) {
    // Most fragments are behind another one: reading is cheaper than a minimum that changes nothing.
    if key < window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) {
        window_atomic_min(ID_PAIRS_KEY, PEELING_FRONT, pixel, key);
    }
}

fn peeling_find(pixel: u32, entry: Packed) {
    let id = id_pairs_id(entry);
    if peeling_is_in_window(pixel, entry.key, id) {
        id_pairs_find(PEELING_FRONT, pixel, id);
    }
}

fn peeling_is_in_window(pixel: u32, key: u32, id: u32) -> bool {
    return key == window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) && id_pairs_is_left(PEELING_FRONT, pixel, id);
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    let entry = fragment_pack(fragment);
    let pixel = pixel_index(position);
    let id = id_pairs_id(entry);
    return !(peeling_is_in_window(pixel, entry.key, id) && id_pairs_takes(PEELING_FRONT, pixel, id));
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let entry = fragment_pack(fragment);
    let pixel = pixel_index(position);
    let id = id_pairs_id(entry);
    if entry.key > window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) {
        peeling_find_next(pixel, entry.key);
        return false;
    }
    if !peeling_is_in_window(pixel, entry.key, id) {
        return false;
    }
    if !id_pairs_takes(PEELING_FRONT, pixel, id) {
        id_pairs_leave(PEELING_FRONT, pixel);
        return false;
    }
    return true;
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
    let is_least = id_pairs_id(entry) == found_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel);
    return select(PEELING_GREATEST, PEELING_LEAST, is_least);
}

fn peeling_advance() {
    if window_load(ID_PAIRS_KEY, PEELING_FRONT, accumulated_pixel) == EMPTY {
        // The pixel has no layer left.
        return;
    }
    if id_pairs_advance(PEELING_FRONT, accumulated_pixel) {
        accumulated_join(PEELING_LEAST, PEELING_GREATEST, accumulated_pixel);
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    return window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
}
