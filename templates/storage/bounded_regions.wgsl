// The k+-buffer in exact regions (K15 sec. 4.1, Alg. 3, corrected). One geometry pass counts fragments, a prefix sum
// over min(f, k) turns the counts into offsets, and a second geometry pass stores. In a pixel with at most k
// fragments, each fragment decrements the count, which reserves a slot for it without a lock. An over-capacity pixel
// (f > k) uses its region as a max array, or as a max heap if k > ARRAY_MOST, under the lock. The count is not limited
// while fragments are counted: the published check before the addition overshoots k, and cannot tell f = k from f > k.
// The k of a pixel is that of the frame, unless the allocation gives each pixel its own.
//
// Invariant: in an over-capacity pixel, at every instant, the key of slot 0 is EMPTY or at least the k-th best key so
// far. The array or the heap keeps it so, and it is EMPTY until k fragments are stored. So the bound is that word, and
// no separate word stores it. Other pixels have no bound, and one invocation writes each of their slots.
//
// Memory: entry_words words for each of min(f, k) fragments, 2 per pixel, and the lock's.

/// The count of an over-capacity pixel has bit 31 set and bit 30 clear; the other bits are the number of kept
/// fragments. Decrementing below 0 sets both bits.
const OVER_CAPACITY = 0x80000000u;

fn storage_count(pixel: u32) {
    counts_atomic_add(pixel, 1u);
}

fn storage_fragments(pixel: u32) -> u32 {
    return counts_load(pixel);
}

fn storage_size(pixel: u32) -> u32 {
    let fragments = counts_load(pixel);
    // Padding has no fragments, and nor have rows below the frame. A pixel that has one fragment keeps it.
    if fragments <= 1u {
        return fragments;
    }
    return min(fragments, allocation_slots(pixel));
}

fn storage_reset(pixel: u32) {
    if counts_load(pixel) <= storage_size(pixel) {
        return;
    }
    kept_counts_store(pixel, 0u);
    if offsets_load(pixel + 1u) <= frame.kept {
        keys_store(0u, pixel, EMPTY);
    }
}

fn storage_bound(pixel: u32) -> u32 {
    if !bounded_regions_is_over_capacity(pixel) || offsets_load(pixel + 1u) > frame.kept {
        return EMPTY;
    }
    return keys_hint(0u, pixel);
}

fn storage_reserve(pixel: u32, entry: Packed) -> bool {
    if bounded_regions_is_over_capacity(pixel) {
        return false;
    }
    let begin = offsets_load(pixel);
    let size = offsets_load(pixel + 1u) - begin;
    let slot = counts_atomic_sub(pixel, 1u) - 1u;
    // A fragment that the first pass did not count gets no slot, so it never writes into the next region.
    if slot >= size || begin + slot >= frame.kept {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return true;
    }
    region_entries_store(begin + slot, entry);
    region_keys_store(begin + slot, entry.key);
    return true;
}

fn storage_insert(pixel: u32, entry: Packed) {
    if offsets_load(pixel + 1u) > frame.kept {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    if allocation_slots(pixel) > ARRAY_MOST {
        heap_insert(pixel, entry);
    } else {
        array_insert(pixel, entry);
    }
}

fn storage_worst(pixel: u32) -> u32 {
    // Only over-capacity pixels displace fragments, and array and heap keep the worst in the same slot.
    return offsets_load(pixel) + array_worst(pixel);
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    array_replace(pixel, cursor - offsets_load(pixel), entry);
}

fn storage_first(pixel: u32) -> u32 {
    let begin = offsets_load(pixel);
    let size = offsets_load(pixel + 1u) - begin;
    if bounded_regions_is_over_capacity(pixel) {
        return bounded_regions_cursor(pixel, begin + size - kept_counts_load(pixel));
    }
    // Slots are reserved from the last down; no fragment reserved those below the count.
    let left = counts_load(pixel);
    return bounded_regions_cursor(pixel, begin + select(left, 0u, left > size));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return bounded_regions_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return region_entries_load(cursor, region_keys_load(cursor));
}

fn bounded_regions_is_over_capacity(pixel: u32) -> bool {
    return counts_load(pixel) >> 30u == OVER_CAPACITY >> 30u;
}

/// Returns the cursor if it is in the region. A cursor is the number of a slot in all regions.
fn bounded_regions_cursor(pixel: u32, cursor: u32) -> u32 {
    return select(END, cursor, cursor < min(offsets_load(pixel + 1u), frame.kept));
}

// Accessors that the array and the heap use as their memory: slots of the pixel's region.

fn keys_load(slot: u32, pixel: u32) -> u32 {
    return region_keys_load(offsets_load(pixel) + slot);
}

fn keys_store(slot: u32, pixel: u32, key: u32) {
    region_keys_store(offsets_load(pixel) + slot, key);
}

fn keys_hint(slot: u32, pixel: u32) -> u32 {
    return region_keys_hint(offsets_load(pixel) + slot);
}

fn keys_publish(slot: u32, pixel: u32, key: u32) {
    region_keys_publish(offsets_load(pixel) + slot, key);
}

fn entries_load(slot: u32, pixel: u32, key: u32) -> Packed {
    return region_entries_load(offsets_load(pixel) + slot, key);
}

fn entries_store(slot: u32, pixel: u32, entry: Packed) {
    region_entries_store(offsets_load(pixel) + slot, entry);
}

fn kept_counts_load(pixel: u32) -> u32 {
    return counts_load(pixel) - OVER_CAPACITY;
}

fn kept_counts_store(pixel: u32, kept: u32) {
    counts_store(pixel, OVER_CAPACITY + kept);
}
