// The 32-bit multidepth buffer (Liu et al. 2010; K15 sec. 2, KB-MDT32). A cascade of atomic minima brings the k least
// keys into order: each slot keeps the lesser of what it holds and what comes, the greater goes on to the next slot.
// Of equal keys one slot is kept. The scene is then drawn once more, and each fragment whose key stands in a slot
// writes what it carries beside it. Keys are the bits of the depth, whole: no precision is lost.
//
// Fragments with equal keys write to the same slot: the last one wins, word by word, so that an entry of several
// words may be of several fragments. storage/cascade keeps equal keys, and settles them.
//
// Invariant: slots only fall, and a key that has gone past a slot stays greater than what the slot holds. So no key
// ever stands in two slots, no key of the k least distinct ones is dropped, and the key of slot k-1 is never below
// the k-th of them: it may be read at any time.
//
// Memory: k * entry_words words per pixel. Geometry passes: 2.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(frame.k - 1u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    var carried = entry.key;
    for (var slot = 0u; slot < frame.k; slot++) {
        let resident = keys_atomic_min(slot, pixel, carried);
        if resident == carried {
            // It stands here already, and whoever moves it on carries one for both.
            count_loss(EQUAL_KEYS);
            return;
        }
        carried = max(carried, resident);
        if carried == EMPTY {
            return;
        }
    }
    // Only the key of the one that falls out is known here.
    count_loss(DISPLACED);
}

fn storage_settle(pixel: u32, entry: Packed) {
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key {
            entries_store(slot, pixel, entry);
        }
        if key >= entry.key {
            return;
        }
    }
}

fn storage_first(pixel: u32) -> u32 {
    return distinct_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return distinct_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

fn distinct_cursor(pixel: u32, slot: u32) -> u32 {
    if slot < frame.k && keys_load(slot, pixel) != EMPTY {
        return slot;
    }
    return END;
}
