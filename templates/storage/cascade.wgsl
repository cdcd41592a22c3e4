// Multidepth in portable WGSL, without a lock and for any payload (after Liu et al. 2010; K15 sec. 2). A cascade of
// atomic minima brings the k least keys into order: each slot keeps the lesser of what it holds and what comes, the
// greater goes on to the next slot. Equal keys each take a slot of their own. Then the scene is drawn once for every
// word beside the key, and each time the same cascade runs among those slots whose earlier words are the fragment's:
// they have been settled by a pass before, and no pass changes what it compares.
//
// So the slots end up with the k least fragments in the order of all their words, whatever the order of arrival: ties
// at the edge are decided as everywhere, and no fragment is torn. The 32-bit multidepth buffer of the papers drops
// equal depths, and writes payloads of equal depths over each other.
//
// Invariant: the key of slot k-1 only ever falls, and never below the k-th least: it may be read at any time.
//
// Memory: k * entry_words words per pixel. Geometry passes: entry_words.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
        for (var word = 0u; word < BESIDE_WORDS; word++) {
            // No word is greater: a slot that a fragment of such words owns need not be written.
            tails_store(slot, pixel, word, EMPTY);
        }
    }
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(frame.k - 1u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    var carried = entry.key;
    for (var slot = 0u; slot < frame.k; slot++) {
        carried = max(carried, keys_atomic_min(slot, pixel, carried));
        if carried == EMPTY {
            return;
        }
    }
    // Only the key of the one that falls out is known here.
    count_loss(DISPLACED);
}

fn storage_settle(pixel: u32, entry: Packed) {
    let word = frame.iteration;
    var carried = packed_word(entry, word);
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key > entry.key {
            return;
        }
        if key == entry.key && cascade_is_prefix(pixel, slot, entry, word) {
            carried = max(carried, tails_atomic_min(slot, pixel, word, carried));
        }
    }
}

fn storage_first(pixel: u32) -> u32 {
    return cascade_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return cascade_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    var entry = packed_of_key(keys_load(cursor, pixel));
    for (var word = 0u; word < BESIDE_WORDS; word++) {
        entry = packed_with(entry, word, tails_load(cursor, pixel, word));
    }
    return entry;
}

/// Whether the slot's words before `end` are the fragment's.
fn cascade_is_prefix(pixel: u32, slot: u32, entry: Packed, end: u32) -> bool {
    for (var word = 0u; word < end; word++) {
        if tails_load(slot, pixel, word) != packed_word(entry, word) {
            return false;
        }
    }
    return true;
}

fn cascade_cursor(pixel: u32, slot: u32) -> u32 {
    if slot < frame.k && keys_load(slot, pixel) != EMPTY {
        return slot;
    }
    return END;
}
