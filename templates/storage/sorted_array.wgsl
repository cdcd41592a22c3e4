// The k-buffer (Bavoil et al. 2007): k entries per pixel in the order of their keys. A fragment walks the array
// from the best entry on; where it is better it takes the slot, and what stood there walks on in its place.
//
// Without a critical section two fragments of one pixel may walk at once. Every word is atomic, so that what they
// read is always some word that was written; but entries can be lost, doubled, torn and left unsorted.
//
// Memory: k * entry_words words per pixel.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(frame.k - 1u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    var carried = entry;
    for (var slot = 0u; slot < frame.k; slot++) {
        let resident = sorted_array_read(pixel, slot);
        if better(carried, resident) {
            entries_store(slot, pixel, carried);
            keys_store(slot, pixel, carried.key);
            carried = resident;
        }
        if carried.key == EMPTY {
            return;
        }
    }
    on_lost(pixel, carried, DISPLACED);
}

fn storage_first(pixel: u32) -> u32 {
    return sorted_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return sorted_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return sorted_array_read(pixel, cursor);
}

fn sorted_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

/// The first slot from `slot` on that holds a fragment: races can leave holes.
fn sorted_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
