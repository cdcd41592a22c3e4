// The 64-bit multidepth buffer (K15 sec. 2, KB-MDT64). A slot is one word of 64 bits: the key in the upper half and at
// most one value word in the lower half. A cascade of atomic minima sorts the k least: each slot keeps the lesser of
// its word and the incoming word, and passes the greater to the next slot. A fragment moves as a whole, so none is
// torn and one pass is enough. The value word breaks ties between equal keys, and each of several equal fragments
// takes a slot.
//
// Invariant: slots only decrease, and every fragment that has arrived is in one slot or held by one invocation. So
// slot k-1 is never below the k-th least, and its key can be read at any time.
//
// Memory: 2k words per pixel. A target needs 64-bit atomics that return the old value.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        slots_store(slot, pixel, wide_cascade_pack(EMPTY, EMPTY));
    }
}

fn storage_bound(pixel: u32) -> u32 {
    return wide_cascade_key(slots_load(frame.k - 1u, pixel));
}

fn storage_insert(pixel: u32, entry: Packed) {
    var carried = wide_cascade_pack(entry.key, packed_word(entry, 0u));
    for (var slot = 0u; slot < frame.k; slot++) {
        carried = max(carried, slots_atomic_min(slot, pixel, carried));
        if wide_cascade_key(carried) == EMPTY {
            return;
        }
    }
    on_lost(pixel, wide_cascade_unpack(carried), DISPLACED);
}

fn storage_first(pixel: u32) -> u32 {
    return wide_cascade_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return wide_cascade_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return wide_cascade_unpack(slots_load(cursor, pixel));
}

fn wide_cascade_cursor(pixel: u32, slot: u32) -> u32 {
    if slot < frame.k && wide_cascade_key(slots_load(slot, pixel)) != EMPTY {
        return slot;
    }
    return END;
}

fn wide_cascade_pack(key: u32, beside: u32) -> u64 {
    return (u64(key) << 32u) | u64(beside);
}

fn wide_cascade_key(wide: u64) -> u32 {
    return u32(wide >> 32u);
}

fn wide_cascade_unpack(wide: u64) -> Packed {
    // The subtraction removes the upper half and leaves the value word.
    let key = wide_cascade_key(wide);
    return packed_with(packed_of_key(key), 0u, u32(wide - (u64(key) << 32u)));
}
