// K15 Alg. 2 as printed, to be refused by whoever checks interleavings: slots are given out by the counter and stored
// later, while the holder of the lock may read them. With k = 2 two fragments suffice: the first has slot 1 and has not
// stored; the second, inside, finds EMPTY there, takes that for the worst, moves it to slot 0 and itself to slot 1,
// where the first one's late store overwrites it.
//
// The index is mended (the printed k-counter-2 is beyond the array), and every slot begins EMPTY; nothing else is. It
// takes the place of storage/revised_array, in the same row.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
    tickets_store(pixel, 0u);
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(0u, pixel);
}

fn storage_reserve(pixel: u32, entry: Packed) -> bool {
    // A helper lane's ticket is worth nothing, and nothing that it stores arrives.
    if is_helper_lane() {
        return true;
    }
    let ticket = tickets_atomic_add(pixel, 1u);
    let has_slot = ticket + 1u < frame.k;
    if has_slot {
        let slot = frame.k - 1u - ticket;
        revised_array_write(pixel, slot, entry);
        return true;
    }
    return false;
}

fn storage_insert(pixel: u32, entry: Packed) {
    let worst = revised_array_read(pixel, 0u);
    if worst.key != EMPTY {
        if !better(entry, worst) {
            on_lost(pixel, entry, DISPLACED);
            return;
        }
        on_lost(pixel, worst, DISPLACED);
    }
    revised_array_replace_worst(pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return revised_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return revised_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return revised_array_read(pixel, cursor);
}

/// Puts `entry` among slots 1 ... k-1 and the worst of all into slot 0, whose fragment is given up.
fn revised_array_replace_worst(pixel: u32, entry: Packed) {
    var worst = entry;
    var worst_slot = 0u;
    for (var slot = 1u; slot < frame.k; slot++) {
        let resident = revised_array_read(pixel, slot);
        if better(worst, resident) {
            worst = resident;
            worst_slot = slot;
        }
    }
    revised_array_write(pixel, 0u, worst);
    if worst_slot != 0u {
        revised_array_write(pixel, worst_slot, entry);
    }
}

fn revised_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

fn revised_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

/// The first slot from `slot` on that holds a fragment.
fn revised_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
