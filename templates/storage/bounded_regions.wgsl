// The k+-buffer in exact regions (K15 sec. 4.1, Alg. 3, mended). One geometry pass counts, a prefix sum over min(f,
// k) turns counts into offsets, a second geometry pass stores. Where a pixel has no more than k fragments, its count
// is counted down and gives every one a slot of its own, without a lock. Where it has more, it is crowded: its region
// is a max array, or for k > ARRAY_MOST a max heap, and writers take turns. The count is not bounded while it is
// taken: the printed check before the addition overshoots k, and cannot tell f = k from f > k.
//
// Invariant: at every instant the key of slot 0 of a crowded pixel is EMPTY, or no fragment of the k best so far
// exceeds it: it is the array's, or the heap's, and EMPTY until k fragments are in. So the bound is that word and
// needs none of its own. Any other pixel has no bound, and every slot of it is written by one invocation.
//
// Memory: entry_words words for each of min(f, k) fragments, 2 per pixel, and the lock's.

/// A crowded pixel's count has bit 31 set and bit 30 clear, and in the other bits how many fragments are kept. Counting
/// down below 0 sets both.
const CROWDED = 0x80000000u;

fn storage_count(pixel: u32) {
    counts_atomic_add(pixel, 1u);
}

fn storage_size(pixel: u32) -> u32 {
    return min(counts_load(pixel), frame.k);
}

fn storage_reset(pixel: u32) {
    if counts_load(pixel) <= frame.k {
        return;
    }
    filled_store(pixel, 0u);
    if offsets_load(pixel + 1u) <= frame.kept {
        keys_store(0u, pixel, EMPTY);
    }
}

fn storage_bound(pixel: u32) -> u32 {
    if !bounded_regions_is_crowded(pixel) || offsets_load(pixel + 1u) > frame.kept {
        return EMPTY;
    }
    return keys_load(0u, pixel);
}

fn storage_reserve(pixel: u32, entry: Packed) -> bool {
    if bounded_regions_is_crowded(pixel) {
        return false;
    }
    let begin = offsets_load(pixel);
    let size = offsets_load(pixel + 1u) - begin;
    let slot = counts_atomic_sub(pixel, 1u) - 1u;
    // A fragment that the first pass did not see finds no slot, and never writes into a neighbour.
    if slot >= size || begin + slot >= frame.kept {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return true;
    }
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
    return true;
}

fn storage_insert(pixel: u32, entry: Packed) {
    if offsets_load(pixel + 1u) > frame.kept {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    if frame.k > ARRAY_MOST {
        heap_insert(pixel, entry);
    } else {
        array_insert(pixel, entry);
    }
}

fn storage_worst(pixel: u32) -> u32 {
    // Fragments are displaced in crowded pixels alone, and array and heap have the worst at the same slot.
    return array_worst(pixel);
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    array_replace(pixel, cursor, entry);
}

fn storage_first(pixel: u32) -> u32 {
    let size = offsets_load(pixel + 1u) - offsets_load(pixel);
    if bounded_regions_is_crowded(pixel) {
        return bounded_regions_cursor(pixel, size - filled_load(pixel));
    }
    // Slots are given out from the last on; those below the count were not asked for.
    let left = counts_load(pixel);
    return bounded_regions_cursor(pixel, select(left, 0u, left > size));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return bounded_regions_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

fn bounded_regions_is_crowded(pixel: u32) -> bool {
    return counts_load(pixel) >> 30u == CROWDED >> 30u;
}

fn bounded_regions_cursor(pixel: u32, slot: u32) -> u32 {
    let begin = offsets_load(pixel);
    let end = min(offsets_load(pixel + 1u), frame.kept);
    return select(END, slot, begin + slot < end);
}

// What the array and the heap take for their memory: slots of the pixel's region.

fn keys_load(slot: u32, pixel: u32) -> u32 {
    return region_keys_load(offsets_load(pixel) + slot);
}

fn keys_store(slot: u32, pixel: u32, key: u32) {
    region_keys_store(offsets_load(pixel) + slot, key);
}

fn entries_load(slot: u32, pixel: u32, key: u32) -> Packed {
    return region_entries_load(offsets_load(pixel) + slot, key);
}

fn entries_store(slot: u32, pixel: u32, entry: Packed) {
    region_entries_store(offsets_load(pixel) + slot, entry);
}

fn filled_load(pixel: u32) -> u32 {
    return counts_load(pixel) - CROWDED;
}

fn filled_store(pixel: u32, filled: u32) {
    counts_store(pixel, CROWDED + filled);
}
