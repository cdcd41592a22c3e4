// One fragment for each slot of an iteration of peeling (Bavoil & Myers 2008; Vasilakis & Fudos 2013, D13 sec. 3.1:
// DUAL, F2B-2P, DUAL-2P, BUN): of a side, of an id, of a bucket. The fragments of a slot have equal keys. The first
// takes the slot by an exchange of its key, and the others are counted: with ids in `peeling` that differ, there are
// none.
//
// Invariant: only the fragment that found the slot empty writes its value words. An exchange by another one stores the
// key that is there. Slots are read only after the pass.
//
// Memory: entry_words words per slot and pixel.

fn storage_insert(pixel: u32, entry: Packed) {
    let slot = peeling_slot(pixel, entry);
    if keys_atomic_exchange(slot, pixel, entry.key) != EMPTY {
        on_lost(pixel, entry, EQUAL_KEYS);
        return;
    }
    entries_store(slot, pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return layer_slots_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return layer_slots_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

/// Returns the first slot from `slot` on that holds a fragment.
fn layer_slots_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < PEELING_SLOTS; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
