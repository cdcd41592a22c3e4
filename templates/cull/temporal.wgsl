// Rejects fragments beyond the bound of their pixel at the end of the last frame (K15 sec. 6), if this frame confirms
// it: a pass over the scene without a lock counts the fragments within that bound. With k or more of them the k best
// are among them, so no fragment beyond can be kept, however camera and objects have moved. With fewer, the last frame
// says nothing about the pixel, and only the test of `early` applies.
//
// Any content of `last_bounds` is sound: after a resize, in a slice of another part of the frame, or in a new scene it
// only culls less.
//
// Memory: 2 words per pixel.

fn cull_key_range(pixel: u32, entry: Packed) {
    if entry.key <= last_bounds_load(pixel) {
        confirmed_atomic_add(pixel, 1u);
    }
}

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    if entry.key > last_bounds_load(pixel) && confirmed_load(pixel) >= frame.k {
        return true;
    }
    return entry.key > storage_bound(pixel);
}

fn cull_occupancy_bound(pixel: u32) {
    last_bounds_store(pixel, storage_bound(pixel));
}
