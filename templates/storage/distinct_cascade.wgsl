// The 32-bit multidepth buffer (Liu et al. 2010; K15 sec. 2, KB-MDT32). A cascade of atomic minima sorts the k least
// keys: each slot keeps the lesser of its key and the incoming key, and passes the greater to the next slot. Equal
// keys share one slot. The scene is then drawn again, and each fragment whose key is in a slot writes its value words
// there. Keys are all bits of the depth: no precision is lost.
//
// Fragments with equal keys write to the same slot: the last one wins word by word, so the value words of an entry may
// come from several fragments. storage/cascade keeps equal keys and refines them.
//
// Invariant: keys in slots only decrease, and a key that has passed a slot stays greater than the slot's. So no key is
// in two slots, none of the k least distinct keys is dropped, and the key of slot k-1 is never below the k-th of them:
// it can be read at any time.
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
            // The key is stored already; if a fragment moves it, one copy moves for both.
            count_loss(EQUAL_KEYS);
            return;
        }
        carried = max(carried, resident);
        if carried == EMPTY {
            return;
        }
    }
    // Only the key of the evicted fragment is known here.
    count_loss(DISPLACED);
}

fn storage_refine(pixel: u32, entry: Packed) {
    // Keys are final here, so most fragments that are not kept need one access.
    if entry.key > keys_load(frame.k - 1u, pixel) {
        return;
    }
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
    return distinct_cascade_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return distinct_cascade_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

fn distinct_cascade_cursor(pixel: u32, slot: u32) -> u32 {
    if slot < frame.k && keys_load(slot, pixel) != EMPTY {
        return slot;
    }
    return END;
}
