// A k-buffer of one entry: the best fragment of a pixel (K15 sec. 4.3, k = 1). Unlike a depth test it supports any
// criterion and a payload of any size. Memory cleared to ones is empty pixels: their key is EMPTY, and every fragment
// is better.
//
// Invariant: the key in memory only decreases, and is never below the best key so far, so the early cull can read it
// without the lock.
//
// Memory: entry_words words per pixel, and the lock's.

fn storage_bound(pixel: u32) -> u32 {
    return entries_load(pixel).key;
}

fn storage_insert(pixel: u32, entry: Packed) {
    let resident = entries_load(pixel);
    if !better(entry, resident) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    entries_store(pixel, entry);
    if resident.key != EMPTY {
        on_lost(pixel, resident, DISPLACED);
    }
}

fn storage_first(pixel: u32) -> u32 {
    return select(END, pixel, entries_load(pixel).key != EMPTY);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return END;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor);
}
