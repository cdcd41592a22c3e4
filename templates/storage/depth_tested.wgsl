// The Z-buffer (Catmull 1974), as the k-buffer with k = 1 (K15 sec. 4.3): the depth test keeps the nearest fragment,
// and the same draw writes its other words to render targets, one word each. The depth attachment is the key: no word
// is stored twice.
//
// Depth test and targets are fixed function: fragments of one pixel are processed in submission order, and the first
// of equal depths is kept. Fragments that fail the test are not counted. The attachment is cleared to 1.0, so a
// fragment at exactly 1.0, on the far plane, is not less and is not kept.
//
// Memory: entry_words words per pixel, in textures.

fn storage_first(pixel: u32) -> u32 {
    if depths_load(pixel) < 1.0 {
        return 0u;
    }
    return END;
}

/// Returns END: there is one fragment.
fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return END;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(pixel, depth_bits(depths_load(pixel)));
}
