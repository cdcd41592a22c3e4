// The scene is drawn again and again, without a lock, until a pass changes no key (after Liu et al. 2009, KB-Multi). A
// fragment whose key stands in a slot writes what it carries there once more, because a race may have left another's
// beside it; one that is better than the worst takes the worst one's slot, and says that something has changed.
//
// Two equal keys can come to stand in two slots, when two fragments take different slots for the worst. Then the second
// is given up, and something has changed: else the fragment that it has driven out would never come back.
//
// Invariant: after a pass in which no key has changed every fragment has seen the same keys, and either found its own
// once or none that is worse. So they are the k least distinct ones, and what stands beside each was written by a
// fragment of that key.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    var worst = 0u;
    var worst_slot = 0u;
    var is_there = false;
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key && is_there {
            keys_store(slot, pixel, EMPTY);
            changed_store(1u);
        } else if key == entry.key {
            entries_store(slot, pixel, entry);
            is_there = true;
        } else if key >= worst {
            worst = key;
            worst_slot = slot;
        }
    }
    if is_there || entry.key >= worst {
        return;
    }
    entries_store(worst_slot, pixel, entry);
    keys_store(worst_slot, pixel, entry.key);
    changed_store(1u);
}

fn storage_first(pixel: u32) -> u32 {
    return repeated_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return repeated_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

fn repeated_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
