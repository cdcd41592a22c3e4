// The revised k+-buffer's array (K15 sec. 3.2.1, Alg. 2, corrected). An atomic counter reserves slots k-1, k-2, ... 1
// for the first k-1 fragments, which are stored without the lock. Later fragments take the lock and keep the worst at
// slot 0.
//
// The published algorithm reads slots inside the lock that are reserved but not stored yet, and loses fragments. So
// here every slot begins EMPTY, value words are stored before the key, and each fragment after the first k-1 waits,
// before the lock, until only slot 0 can be EMPTY. The wait is bounded, because no API guarantees forward progress of
// the other fragments; a fragment that times out is counted. (The published index k-counter-2 is corrected too.)
//
// Invariants. One invocation writes each of slots 1 ... k-1 outside the lock; fragments inside the lock write a slot
// only after it has been seen written. At every instant the key of slot 0 is EMPTY, or at least the k-th best key so
// far: an insert first finds the new worst fragment and then writes slot 0 once, and only when slots 1 ... k-1 are
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
    // The atomics and stores of a helper invocation have no effect.
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
    // A branch of its own, so that lanes with a slot store before other lanes of their wave begin to wait.
    if has_slot {
        return true;
    }
    if !revised_array_wait(pixel) {
        on_lost(pixel, entry, TIMED_OUT);
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
    // After the stores, so that the overflow row reads the kept fragments in their final slots.
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

/// Waits until slots 1 ... k-1 are written and returns false on timeout. Written slots stay written.
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
