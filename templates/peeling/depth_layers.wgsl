// Peeling of depth layers (Vasilakis & Fudos 2013, D13 sec. 3.1.3 and 3.2.1: F2B-LL, F2B-B). An iteration stores the
// fragments of one depth in each pixel, all of them, in any storage that keeps what it is given: fragments of equal
// depth are not lost. The effect goes on where it stopped.
//
// The papers draw the scene twice per iteration: for the depth of the next layer, and for its fragments. Here the pass
// that stores a layer also finds the next one, so a frame of D layers draws the scene D + 1 times instead of 2 D times,
// and ends with the iteration that stores the last.
//
// Invariant: the layer's key is the least of the pixel that no earlier iteration has stored, and the next key is the
// least beyond it that the present pass has met. Keys are read in the passes after the one that lowers them, so the
// order of fragments has no effect.
//
// Memory: 6 words per pixel, and one word.

fn peeling_find_first(pixel: u32, key: u32) {
    // Most fragments are behind another one: reading is cheaper than a minimum that changes nothing.
    if key < layer_keys_load(pixel) {
        layer_keys_atomic_min(pixel, key);
    }
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    return fragment_pack(fragment).key != layer_keys_load(pixel_index(position));
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let pixel = pixel_index(position);
    let key = fragment_pack(fragment).key;
    let layer = layer_keys_load(pixel);
    if key > layer {
        peeling_find_next(pixel, key);
    }
    return key == layer;
}

fn peeling_find_next(pixel: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    if key < next_keys_load(pixel) && next_keys_atomic_min(pixel, key) == EMPTY {
        remaining_store(1u);
    }
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    return 0u;
}

fn peeling_reached(pixel: u32) -> u32 {
    return next_keys_load(pixel);
}
