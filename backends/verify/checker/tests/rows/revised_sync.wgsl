// K15 Alg. 2 as printed: the counter reserves a slot, which is written later, while the lock holder may read it.

const FREE = 0u;
const TAKEN = 1u;

fn sync_store(pixel: u32, entry: Packed) {
    if is_helper_lane() {
        return;
    }
    let reserved = kept_counts_atomic_add(pixel, 1u);
    if reserved + 1u < frame.k {
        max_array_write(pixel, frame.k - 1u - reserved, entry);
        return;
    }
    for (var attempt = 0u; attempt < SPIN_LIMIT; attempt++) {
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
