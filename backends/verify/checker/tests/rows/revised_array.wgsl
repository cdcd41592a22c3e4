// K15 Alg. 2 as printed, the part inside the lock. Outside it, the counter assigns the first k - 1 slots.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
    kept_counts_store(pixel, 0u);
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(0u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let worst = max_array_read(pixel, 0u);
    if worst.key != EMPTY {
        if !better(entry, worst) {
            on_lost(pixel, entry, DISPLACED);
            return;
        }
        on_lost(pixel, worst, DISPLACED);
    }
    max_array_replace_worst(pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return revised_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return revised_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return max_array_read(pixel, cursor);
}

/// Writes `entry` to slots 1 ... k-1, and the worst of all entries to slot 0, whose fragment is displaced.
fn max_array_replace_worst(pixel: u32, entry: Packed) {
    var worst = entry;
    var worst_slot = 0u;
    for (var slot = 1u; slot < frame.k; slot++) {
        let resident = max_array_read(pixel, slot);
        if better(worst, resident) {
            worst = resident;
            worst_slot = slot;
        }
    }
    max_array_write(pixel, 0u, worst);
    if worst_slot != 0u {
        max_array_write(pixel, worst_slot, entry);
    }
}

fn max_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

fn max_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

/// Returns the first slot from `slot` on that holds a fragment. A fragment that timed out leaves its slot empty.
fn revised_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
