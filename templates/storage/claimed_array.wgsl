// The A-buffer of fixed arrays without a counter (D13 sec. 3.2.1, Alg. 3, F2B-KB, corrected): a fragment takes the
// first slot whose key is EMPTY, by one compare-exchange of its key. Alg. 3 tests the slot and then writes it, so two
// fragments can take one slot, and it takes a colour of 0 for an empty slot. A word less per pixel than fixed_array,
// but the n-th fragment of a pixel reads n keys.
//
// Invariant: no slot before a taken one is free, and a taken slot belongs to the fragment that took it. Slots are read
// only after the pass, so the order of fragments has no effect.
//
// Memory: n * entry_words words per pixel, for n slots.

fn storage_insert(pixel: u32, entry: Packed) {
    // The exchange of a helper invocation has no effect.
    if is_helper_lane() {
        return;
    }
    var slot = 0u;
    for (var attempt = 0u; attempt < CLAIM_TRIES; attempt++) {
        slot = claimed_array_free(pixel, slot);
        if slot == frame.n {
            on_lost(pixel, entry, POOL_EXHAUSTED);
            return;
        }
        // An exchange may fail without a cause, so the slot is read again before it is passed.
        if keys_atomic_compare_exchange(slot, pixel, EMPTY, entry.key) {
            entries_store(slot, pixel, entry);
            return;
        }
    }
    on_lost(pixel, entry, TIMED_OUT);
}

/// Returns the first slot from `start` on that is free, or the number of slots.
fn claimed_array_free(pixel: u32, start: u32) -> u32 {
    for (var slot = start; slot < frame.n; slot++) {
        if keys_load(slot, pixel) == EMPTY {
            return slot;
        }
    }
    return frame.n;
}

fn storage_first(pixel: u32) -> u32 {
    return claimed_array_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return claimed_array_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

fn claimed_array_cursor(pixel: u32, slot: u32) -> u32 {
    if slot >= frame.n {
        return END;
    }
    return select(END, slot, keys_load(slot, pixel) != EMPTY);
}
