// One lock word per pixel (K15 sec. 3.2). The number of tries is bounded, because no API guarantees forward progress
// of the lock holder; a fragment that times out is counted. Memory: 1 word per pixel.
//
// The fences make the stores of the last holder visible to the next. Plain WGSL has no fence in fragment shaders: there
// the order depends on what GPUs happen to do (tier T4).

const FREE = 0u;
const TAKEN = 1u;

fn sync_store(pixel: u32, entry: Packed) {
    // The exchange of a helper invocation has no effect: it would never see the lock free.
    if is_helper_lane() {
        return;
    }
    // No `return` inside the loop: lanes of a wave that wait must join the lane with the lock after each try, or they
    // can use up their tries before it runs.
    var is_waiting = true;
    for (var attempt = 0u; attempt < SPIN_LIMIT && is_waiting; attempt++) {
        if locks_atomic_exchange(pixel, TAKEN) == FREE {
            memory_fence();
            storage_insert(pixel, entry);
            memory_fence();
            locks_store(pixel, FREE);
            is_waiting = false;
        }
    }
    if is_waiting {
        on_lost(pixel, entry, TIMED_OUT);
    }
}
