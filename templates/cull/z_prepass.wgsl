// A pass over the scene finds the key of each pixel's best fragment before any is stored: a depth pre-pass by atomic
// minima, for any criterion. The store pass then rejects all other fragments, for any order of arrival: only the best
// fragment of a pixel, and fragments with an equal key, take the lock. For `keep 1`.
//
// Memory: 1 word per pixel.

fn cull_key_range(pixel: u32, entry: Packed) {
    prepass_atomic_min(pixel, entry.key);
}

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return entry.key > prepass_load(pixel);
}
