// The Z-buffer (Catmull 1974), as the k-buffer of k = 1 (K15 sec. 4.3): the depth test keeps the nearest fragment,
// and the same draw leaves its other words in targets, one word each. The depth attachment is the key: no word is
// kept twice.
//
// Depth test and targets are fixed function: fragments of one pixel come one after the other in the order of
// submission, and of equal depths the first stays. Nothing counts what the test turns away. Depths end at 1.0, which
// the attachment is cleared to: a fragment at exactly 1.0, on the far plane, is not less, and is not kept.
//
// Memory: entry_words words per pixel, in textures.

fn storage_first(pixel: u32) -> u32 {
    if depths_load(pixel) < 1.0 {
        return 0u;
    }
    return END;
}

/// There is one fragment.
fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return END;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(pixel, depth_bits(depths_load(pixel)));
}
