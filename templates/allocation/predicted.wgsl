// Counts the fragments of each pixel in a pass of its own, for storages of k slots per pixel (K15 sec. 4.2, fixed
// allocation). The host predicts k from their histogram before any slot is allocated.
//
// Memory: 1 word per pixel, and 1025 words.

fn allocation_count(pixel: u32) {
    complexity_atomic_add(pixel, 1u);
}

fn allocation_fragments(pixel: u32) -> u32 {
    return complexity_load(pixel);
}

fn allocation_slots(pixel: u32) -> u32 {
    return frame.k;
}
