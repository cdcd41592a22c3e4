// Peeling from both sides (Bavoil & Myers 2008; Vasilakis & Fudos 2013, D13 sec. 3.1.3 and 3.2.1: DUAL-LL, DUAL-B). As
// depth_layers, but an iteration stores the nearest and the farthest layer that are left in each pixel: D layers take
// ceil(D / 2) iterations. Layers from the front are composited under those before them, layers from the back over those
// behind them; `over` is associative, so the result joins the two.
//
// Invariant: the keys of the two layers are the least and the greatest of the pixel that no earlier iteration has
// stored. If they are equal, the layer is one of the front. Keys of the back are inverted: minima find both.
//
// Memory: 12 words per pixel, and one word.

/// The sides, which are the slots of an iteration's fragments.
const PEELING_FRONT = 0u;
const PEELING_BACK = 1u;

fn peeling_find_first(pixel: u32, key: u32) {
    // Most fragments are between others: reading is cheaper than a minimum that changes nothing.
    if key < layer_keys_load(PEELING_FRONT, pixel) {
        layer_keys_atomic_min(PEELING_FRONT, pixel, key);
    }
    if ~key < layer_keys_load(PEELING_BACK, pixel) {
        layer_keys_atomic_min(PEELING_BACK, pixel, ~key);
    }
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    return !peeling_takes(pixel_index(position), fragment_pack(fragment).key);
}

/// Returns whether this iteration stores a fragment of this key. A key of 0 inverted is EMPTY, which is also the key of
/// a pixel without fragments: nothing is behind its front.
fn peeling_takes(pixel: u32, key: u32) -> bool {
    let front = layer_keys_load(PEELING_FRONT, pixel);
    return key == front || (key > front && ~key == layer_keys_load(PEELING_BACK, pixel));
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let pixel = pixel_index(position);
    let key = fragment_pack(fragment).key;
    if key > layer_keys_load(PEELING_FRONT, pixel) && ~key > layer_keys_load(PEELING_BACK, pixel) {
        peeling_find_next(pixel, key);
    }
    return peeling_takes(pixel, key);
}

fn peeling_find_next(pixel: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    if key < next_keys_load(PEELING_FRONT, pixel) && next_keys_atomic_min(PEELING_FRONT, pixel, key) == EMPTY {
        remaining_store(1u);
    }
    if ~key < next_keys_load(PEELING_BACK, pixel) {
        next_keys_atomic_min(PEELING_BACK, pixel, ~key);
    }
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    return select(PEELING_BACK, PEELING_FRONT, entry.key == layer_keys_load(PEELING_FRONT, pixel));
}

fn peeling_reached(pixel: u32) -> u32 {
    return next_keys_load(PEELING_FRONT, pixel);
}
