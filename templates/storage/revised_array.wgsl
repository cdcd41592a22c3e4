// The revised k+-buffer's array (K15 sec. 3.2.1, Alg. 2, mended). A counter gives the first k-1 fragments slots k-1,
// k-2, ... 1 of their own, stored without a lock; those after them take turns and keep the worst at slot 0.
//
// As printed, who is inside reads slots that have been given out and not yet stored, and loses fragments. So every
// slot begins EMPTY, what stands beside a key is stored before the key, and whoever comes after the first k-1 waits,
// before the lock, until no slot but slot 0 is EMPTY. The wait is bounded, because no API promises that the others
// ever run again; a fragment that is given up is counted. (The printed index k-counter-2 is mended too.)
//
// Invariants. Slots 1 ... k-1 are each written by one invocation outside the lock, and by those inside only after
// they have been seen written. At every instant the key of slot 0 is EMPTY, or at least the k-th best key so far: it
// is written once per insert, straight to the new worst, which is found first, and not before slots 1 ... k-1 are
// full.
//
// Memory: k * entry_words + 1 words per pixel, and the lock's.

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
        entries_store(slot, pixel, entry);
        memory_fence();
        keys_store(slot, pixel, entry.key);
    }
    // Apart from the branch above, so that lanes with a slot have stored before others of their wave begin to wait.
    if has_slot {
        return true;
    }
    if !revised_array_wait(pixel) {
        on_lost(pixel, entry, SPIN_EXHAUSTED);
        return true;
    }
    memory_fence();
    return false;
}

fn storage_insert(pixel: u32, entry: Packed) {
    let worst = revised_array_read(pixel, 0u);
    if !better(entry, worst) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    revised_array_replace_worst(pixel, entry);
    // Whoever is handed what was displaced finds the others in place.
    if worst.key != EMPTY {
        on_lost(pixel, worst, DISPLACED);
    }
}

fn storage_worst(pixel: u32) -> u32 {
    return 0u;
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    revised_array_write(pixel, cursor, entry);
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

/// Waits until slots 1 ... k-1 are written; false: not in time. Slots that have been seen written stay written.
fn revised_array_wait(pixel: u32) -> bool {
    var slot = 1u;
    for (var attempt = 0u; attempt < WAIT_LIMIT; attempt++) {
        while slot < frame.k && keys_load(slot, pixel) != EMPTY {
            slot++;
        }
        if slot >= frame.k {
            return true;
        }
    }
    return false;
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
