// The k+-buffer's heap (K15 sec. 3.2): for large k, where looking through an array for the new worst costs more than
// sifting. Until k fragments are in, they fill slots k-1, k-2, ... in any order; the k-th insert makes a heap of them.
// From then on slot 0 holds the worst kept fragment, and no slot a better one than the two under it.
//
// Invariant: at every instant the key of slot 0 is at least the k-th best key so far. It is EMPTY until all of the
// heap is one, and is then written once per insert, straight to the new worst; the hole that this leaves sifts down.
// (The paper sifts up while the heap fills: slot 0 would hold a key that is no bound yet.)
//
// Memory: k * entry_words + 1 words per pixel, and the lock's.

fn storage_reset(pixel: u32) {
    keys_store(0u, pixel, EMPTY);
    filled_store(pixel, 0u);
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_load(0u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let filled_before = filled_load(pixel);
    if filled_before + 1u < frame.k {
        max_heap_write(pixel, frame.k - 1u - filled_before, entry);
        filled_store(pixel, filled_before + 1u);
        return;
    }
    if filled_before < frame.k {
        filled_store(pixel, frame.k);
        // All that have children, the deepest first; slot 0 comes last, with the new fragment.
        for (var parent = frame.k / 2u; parent > 1u; parent--) {
            max_heap_sift(pixel, parent - 1u, max_heap_read(pixel, parent - 1u));
        }
    }
    let worst = max_heap_read(pixel, 0u);
    if !better(entry, worst) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    max_heap_sift(pixel, 0u, entry);
    // Whoever is handed what was displaced finds the others in place.
    if worst.key != EMPTY {
        on_lost(pixel, worst, DISPLACED);
    }
}

fn storage_worst(pixel: u32) -> u32 {
    return 0u;
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    max_heap_write(pixel, cursor, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return max_heap_cursor(frame.k - filled_load(pixel));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return max_heap_cursor(cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return max_heap_read(pixel, cursor);
}

/// Puts `entry` into the heap under `top`, whose own fragment is given up: worse ones move up into the hole.
fn max_heap_sift(pixel: u32, top: u32, entry: Packed) {
    var hole = top;
    var child = 2u * hole + 1u;
    while child < frame.k {
        var worst = max_heap_read(pixel, child);
        if child + 1u < frame.k {
            let sibling = max_heap_read(pixel, child + 1u);
            if better(worst, sibling) {
                worst = sibling;
                child += 1u;
            }
        }
        if !better(entry, worst) {
            break;
        }
        max_heap_write(pixel, hole, worst);
        hole = child;
        child = 2u * hole + 1u;
    }
    max_heap_write(pixel, hole, entry);
}

fn max_heap_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

fn max_heap_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

fn max_heap_cursor(slot: u32) -> u32 {
    return select(END, slot, slot < frame.k);
}
