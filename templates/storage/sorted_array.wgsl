// The k-buffer (Bavoil et al. 2007): k entries per pixel, sorted by key. A fragment walks the array from the best
// entry on. At the first worse entry it takes the slot, and that entry and all behind it move on by one slot.
//
// Without a critical section two fragments of one pixel may walk the array concurrently. Every word is atomic, so each
// read returns a word that was written; but entries can be lost, duplicated, torn and left unsorted.
//
// Entries behind the taken slot move without a comparison, so entries with equal keys stay in the order of arrival.
//
// Memory: k * entry_words words per pixel.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_hint(frame.k - 1u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    var carried = entry;
    var moving = false;
    for (var slot = 0u; slot < frame.k; slot++) {
        let resident = sorted_array_read(pixel, slot);
        moving = moving || better(carried, resident);
        if moving {
            sorted_array_write(pixel, slot, carried);
            carried = resident;
        }
        if carried.key == EMPTY {
            return;
        }
    }
    on_lost(pixel, carried, DISPLACED);
}

fn storage_worst(pixel: u32) -> u32 {
    return frame.k - 1u;
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    sorted_array_write(pixel, cursor, entry);
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

/// Writes an entry. Only the key of the last slot is the bound, which is read outside of a critical section.
fn sorted_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    if slot + 1u == frame.k {
        keys_publish(slot, pixel, entry.key);
    } else {
        keys_store(slot, pixel, entry.key);
    }
}

/// Returns the first slot from `slot` on that holds a fragment: races can leave holes.
fn sorted_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
