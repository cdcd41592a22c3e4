// The S-buffer (Vasilakis & Fudos 2012): one geometry pass counts fragments, a prefix sum turns the counts into
// offsets, and a second geometry pass stores. Regions are contiguous in the order of pixels, so the end of one is the
// offset of the next. In the store pass each fragment decrements the pixel's count, which reserves a slot for it. A
// fragment that the first pass did not count gets no slot, so it never writes into the next region.
//
// Memory: entry_words words per fragment, 2 per pixel.

fn storage_count(pixel: u32) {
    counts_atomic_add(pixel, 1u);
}

fn storage_fragments(pixel: u32) -> u32 {
    return counts_load(pixel);
}

fn storage_size(pixel: u32) -> u32 {
    return counts_load(pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let begin = offsets_load(pixel);
    let size = offsets_load(pixel + 1u) - begin;
    let slot = counts_atomic_sub(pixel, 1u) - 1u;
    // Decrementing below 0 wraps around to slots far beyond any region.
    if slot >= size || begin + slot >= frame.fragments {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    entries_store(begin + slot, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return exact_regions_cursor(pixel, offsets_load(pixel));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return exact_regions_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor);
}

fn exact_regions_cursor(pixel: u32, cursor: u32) -> u32 {
    return select(END, cursor, cursor < min(offsets_load(pixel + 1u), frame.fragments));
}
