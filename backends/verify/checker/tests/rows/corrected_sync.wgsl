// K15 Alg. 2, corrected: before it takes the lock, a fragment waits until every reserved slot has been written.

const FREE = 0u;
const TAKEN = 1u;

fn sync_store(pixel: u32, entry: Packed) {
    if is_helper_lane() {
        return;
    }
    let reserved = kept_counts_atomic_add(pixel, 1u);
    if reserved + 1u < frame.k {
        entries_store(frame.k - 1u - reserved, pixel, entry);
        memory_fence();
        keys_store(frame.k - 1u - reserved, pixel, entry.key);
        return;
    }
    for (var attempt = 0u; attempt < SPIN_LIMIT; attempt++) {
        if !all_written(pixel) {
            continue;
        }
        if locks_atomic_exchange(pixel, TAKEN) == FREE {
            memory_fence();
            storage_insert(pixel, entry);
            memory_fence();
            locks_store(pixel, FREE);
            return;
        }
    }
    on_lost(pixel, entry, TIMED_OUT);
}

fn all_written(pixel: u32) -> bool {
    for (var slot = 1u; slot < frame.k; slot++) {
        if keys_load(slot, pixel) == EMPTY {
            return false;
        }
    }
    return true;
}
