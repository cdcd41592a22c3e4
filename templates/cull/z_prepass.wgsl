// A pass over the scene finds the key of each pixel's best fragment before any is stored: a depth pre-pass by atomic
// minima, for any criterion. The store pass then turns all others away, whatever the order of arrival: one fragment of
// a pixel takes the lock, and those with an equal key. For `keep 1`.
//
// Memory: 1 word per pixel.

fn cull_measure(pixel: u32, entry: Packed) {
    prepass_atomic_min(pixel, entry.key);
}

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return entry.key > prepass_load(pixel);
}
