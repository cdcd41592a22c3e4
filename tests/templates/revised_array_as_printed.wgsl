// K15 Alg. 2 as published, which the checker must reject: the counter reserves slots that are stored later, while the
// lock holder may read them. With k = 2 two fragments suffice. The first has reserved slot 1 and has not stored it. The
// second, inside the lock, finds EMPTY there, treats it as the worst, moves it to slot 0 and stores itself in slot 1,
// where the late store of the first overwrites it.
//
// The index is corrected (the published k-counter-2 is outside the array), and every slot begins EMPTY; nothing else is
// changed. It replaces storage/revised_array, in the same row.

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
    // The atomics and stores of a helper invocation have no effect.
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

/// Replaces the fragment of slot 0: `entry` joins slots 1 ... k-1, and the worst of them all moves to slot 0.
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

/// Returns the first slot from `slot` on that holds a fragment.
fn revised_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
