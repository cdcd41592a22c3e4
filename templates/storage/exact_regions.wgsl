// The S-buffer (Vasilakis & Fudos 2012): one geometry pass counts, a prefix sum turns counts into offsets, a second
// geometry pass stores. Regions lie one after the other in the order of pixels, so the end of one is the offset of
// the next. The store pass counts each pixel's count down again, which gives every fragment a place of its own; a
// fragment that the first pass did not see finds none, and never writes into a neighbour.
//
// Memory: entry_words words per fragment, 2 per pixel.

fn storage_count(pixel: u32) {
    counts_atomic_add(pixel, 1u);
}

fn storage_size(pixel: u32) -> u32 {
    return counts_load(pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let begin = offsets_load(pixel);
    let size = offsets_load(pixel + 1u) - begin;
    let place = counts_atomic_sub(pixel, 1u) - 1u;
    // Counting below 0 wraps around to places far beyond any region.
    if place >= size || begin + place >= frame.fragments {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    entries_store(begin + place, entry);
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
