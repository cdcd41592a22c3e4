// Peeling of fragments of equal depth by their ids, from both sides (Vasilakis & Fudos 2013, D13 sec. 3.1.2: DUAL-2P).
// As id_pairs, but an iteration goes on with the nearest and with the farthest layer that is left in each pixel, so it
// stores the fragments of four ids. Each side passes to its next layer when its own has ended.
//
// Invariant: fragments that no iteration has stored are in the layer of a side or strictly between the two. If both
// sides pass to the same layer, it is one of the front: the back finds nothing there, and ends with this iteration.
//
// Memory: 30 words per pixel, and one word.

/// The sides. Keys of the back are inverted. A side has two slots, for its lesser and its greater ids.
const PEELING_FRONT = 0u;
const PEELING_BACK = 1u;

fn peeling_find_first(pixel: u32, key: u32) {
    // Most fragments are between others: reading is cheaper than a minimum that changes nothing.
    if key < window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) {
        window_atomic_min(ID_PAIRS_KEY, PEELING_FRONT, pixel, key);
    }
    if ~key < window_load(ID_PAIRS_KEY, PEELING_BACK, pixel) {
        window_atomic_min(ID_PAIRS_KEY, PEELING_BACK, pixel, ~key);
    }
}

fn peeling_find(pixel: u32, entry: Packed) {
    let id = id_pairs_id(entry);
    let side = peeling_side(pixel, entry.key);
    if side != END && id_pairs_is_left(side, pixel, id) {
        id_pairs_find(side, pixel, id);
    }
}

/// Returns the side whose layer has this key, or END.
fn peeling_side(pixel: u32, key: u32) -> u32 {
    if key == window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) {
        return PEELING_FRONT;
    }
    return select(END, PEELING_BACK, peeling_is_back(pixel, key));
}

/// A key of 0 inverted is EMPTY, which is also the key of a side without layers: nothing is behind a front of key 0.
fn peeling_is_back(pixel: u32, key: u32) -> bool {
    return key != 0u && ~key == window_load(ID_PAIRS_KEY, PEELING_BACK, pixel);
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    let entry = fragment_pack(fragment);
    let pixel = pixel_index(position);
    let id = id_pairs_id(entry);
    let side = peeling_side(pixel, entry.key);
    return side == END || !id_pairs_is_left(side, pixel, id) || !id_pairs_takes(side, pixel, id);
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let entry = fragment_pack(fragment);
    let pixel = pixel_index(position);
    let id = id_pairs_id(entry);
    let side = peeling_side(pixel, entry.key);
    if side == END {
        peeling_find_next(pixel, entry.key);
        return false;
    }
    if !id_pairs_is_left(side, pixel, id) {
        return false;
    }
    if !id_pairs_takes(side, pixel, id) {
        id_pairs_leave(side, pixel);
        return false;
    }
    return true;
}

fn peeling_find_next(pixel: u32, key: u32) {
    let is_behind_front = key > window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    if !is_behind_front || ~key <= window_load(ID_PAIRS_KEY, PEELING_BACK, pixel) {
        return;
    }
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    id_pairs_find_next(PEELING_FRONT, pixel, key);
    id_pairs_find_next(PEELING_BACK, pixel, ~key);
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    let is_front = entry.key == window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    let side = select(PEELING_BACK, PEELING_FRONT, is_front);
    return 2u * side + select(1u, 0u, id_pairs_id(entry) == found_load(ID_PAIRS_LEAST, side, pixel));
}

fn peeling_advance() {
    let pixel = accumulated_pixel;
    if window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel) != EMPTY && id_pairs_advance(PEELING_FRONT, pixel) {
        accumulated_join(0u, 1u, pixel);
    }
    if window_load(ID_PAIRS_KEY, PEELING_BACK, pixel) != EMPTY && id_pairs_advance(PEELING_BACK, pixel) {
        accumulated_join(3u, 2u, pixel);
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    let front = window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    let back = window_load(ID_PAIRS_KEY, PEELING_BACK, pixel);
    // The side without a layer is EMPTY.
    return min(front, select(~back, EMPTY, back == EMPTY));
}
