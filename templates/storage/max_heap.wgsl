// The k+-buffer's heap (K15 sec. 3.2), for large k, where a search through an array for the new worst costs more than
// sifting. The first fragments fill slots k-1, k-2, ... in any order; the k-th insert builds the heap. From then on
// slot 0 holds the worst kept fragment, and no slot holds a better one than its two children.
//
// Invariant: at every instant the key of slot 0 is at least the k-th best key so far. It is EMPTY until the heap is
// built. Each later insert writes it once, with the new worst, and sifts the hole down. (The paper sifts up while the
// heap fills; slot 0 would then hold a key that is no bound yet.)
//
// Memory: k * entry_words + 1 words per pixel, and the lock's.

fn storage_reset(pixel: u32) {
    keys_store(0u, pixel, EMPTY);
    kept_counts_store(pixel, 0u);
}

fn storage_bound(pixel: u32) -> u32 {
    return keys_hint(0u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let kept_before = kept_counts_load(pixel);
    if kept_before + 1u < allocation_slots(pixel) {
        max_heap_write(pixel, allocation_slots(pixel) - 1u - kept_before, entry);
        kept_counts_store(pixel, kept_before + 1u);
        return;
    }
    let worst = max_heap_read(pixel, 0u);
    if !better(entry, worst) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    // The k-th insert sifts every slot with children, the deepest first; each later one sifts slot 0 only.
    var tops = 1u;
    if kept_before < allocation_slots(pixel) {
        kept_counts_store(pixel, allocation_slots(pixel));
        tops = max(allocation_slots(pixel) / 2u, 1u);
    }
    for (; tops > 0u; tops--) {
        var sifted = entry;
        if tops > 1u {
            sifted = max_heap_read(pixel, tops - 1u);
        }
        max_heap_sift(pixel, tops - 1u, sifted);
    }
    // After the stores, so that the overflow row reads the kept fragments in their final slots.
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
    return max_heap_cursor(frame.k - kept_counts_load(pixel));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return max_heap_cursor(cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return max_heap_read(pixel, cursor);
}

/// Replaces the fragment of slot `top` by `entry`: worse fragments below it move up into the hole.
fn max_heap_sift(pixel: u32, top: u32, entry: Packed) {
    var hole = top;
    var child = 2u * hole + 1u;
    while child < allocation_slots(pixel) {
        var worst = max_heap_read(pixel, child);
        if child + 1u < allocation_slots(pixel) {
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

/// Writes an entry. Only the key of slot 0 is read outside of the critical section.
fn max_heap_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    if slot == 0u {
        keys_publish(slot, pixel, entry.key);
    } else {
        keys_store(slot, pixel, entry.key);
    }
}

fn max_heap_cursor(slot: u32) -> u32 {
    return select(END, slot, slot < frame.k);
}
