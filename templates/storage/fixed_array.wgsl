// The A-buffer of fixed arrays (FreePipe, Liu et al. 2010; FAB): an atomic counter per pixel reserves a slot for every
// fragment until the slots are used up. The counter keeps counting, so it also gives the number of fragments.
//
// Memory: n * entry_words + 1 words per pixel, for n slots.

fn storage_insert(pixel: u32, entry: Packed) {
    let slot = counts_atomic_add(pixel, 1u);
    if slot >= frame.n {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    entries_store(slot, pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return fixed_array_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return fixed_array_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel);
}

fn fixed_array_cursor(pixel: u32, slot: u32) -> u32 {
    return select(END, slot, slot < min(counts_load(pixel), frame.n));
}
