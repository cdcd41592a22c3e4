// Multidepth in portable WGSL, without a lock and for any payload (after Liu et al. 2010; K15 sec. 2). A cascade of
// atomic minima sorts the k least keys: each slot keeps the lesser of its key and the incoming key, and passes the
// greater to the next slot. Each of several equal keys takes a slot. Then the scene is drawn once for every value
// word. In each of these passes the same cascade runs over the slots whose preceding words equal the fragment's:
// earlier passes have made these words final, and no pass changes a word that it compares.
//
// So the slots hold the k least fragments in the order of all their words, for any order of arrival: ties at the k-th
// slot are resolved as everywhere, and no fragment is torn. The papers' 32-bit multidepth buffer drops equal depths
// and lets the payloads of equal depths overwrite each other.
//
// Invariant: the key of slot k-1 only decreases, and is never below the k-th least: it can be read at any time.
//
// Memory: k * entry_words words per pixel. Geometry passes: entry_words.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
        for (var word = 0u; word < VALUE_WORDS; word++) {
            // EMPTY is the greatest word, so a value word that equals it need not be written.
            value_words_store(slot, pixel, word, EMPTY);
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
    // Only the key of the evicted fragment is known here.
    count_loss(DISPLACED);
}

fn storage_refine(pixel: u32, entry: Packed) {
    // Keys are final here, so most fragments that are not kept need one access.
    if entry.key > keys_load(frame.k - 1u, pixel) {
        return;
    }
    let word = frame.iteration;
    var carried = packed_word(entry, word);
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key > entry.key {
            return;
        }
        if key == entry.key && cascade_is_prefix(pixel, slot, entry, word) {
            carried = max(carried, value_words_atomic_min(slot, pixel, word, carried));
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
    for (var word = 0u; word < VALUE_WORDS; word++) {
        entry = packed_with(entry, word, value_words_load(cursor, pixel, word));
    }
    return entry;
}

/// Returns whether the value words of the slot before `end` equal the fragment's.
fn cascade_is_prefix(pixel: u32, slot: u32, entry: Packed, end: u32) -> bool {
    for (var word = 0u; word < end; word++) {
        if value_words_load(slot, pixel, word) != packed_word(entry, word) {
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
