// One lock word per pixel (K15 sec. 3.2). The number of tries is bounded, because no API promises that the holder
// ever runs again; a fragment that is given up is counted. Memory: 1 word per pixel.
//
// The fences make what the last holder wrote visible to the next. Plain WGSL has none in a fragment shader: there
// the order rests on what GPUs happen to do (tier T4).

const FREE = 0u;
const TAKEN = 1u;

fn sync_store(pixel: u32, entry: Packed) {
    // A helper lane never sees the lock free: its exchange has no effect.
    if is_helper_lane() {
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
    on_lost(pixel, entry, SPIN_EXHAUSTED);
}
