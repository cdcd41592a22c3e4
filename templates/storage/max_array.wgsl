// The k+-buffer's array (K15 sec. 3.2). Slots k-1, k-2, ... fill first. Slot 0 is written last and then holds the
// worst kept fragment. Until then its key is EMPTY, which no key exceeds.
//
// Invariant: at every instant the key of slot 0 is at least the k-th best key so far. So a fragment can be culled by
// reading this one word outside the lock. The insert first finds the new worst fragment, writes it to slot 0 once, and
// then fills the slot that it left.
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
        max_array_write(pixel, allocation_slots(pixel) - 1u - kept_before, entry);
        kept_counts_store(pixel, kept_before + 1u);
        return;
    }
    if kept_before < allocation_slots(pixel) {
        kept_counts_store(pixel, allocation_slots(pixel));
    }
    let worst = max_array_read(pixel, 0u);
    if !better(entry, worst) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    max_array_replace_worst(pixel, entry);
    // After the stores, so that the overflow row reads the kept fragments in their final slots.
    if worst.key != EMPTY {
        on_lost(pixel, worst, DISPLACED);
    }
}

fn storage_worst(pixel: u32) -> u32 {
    return 0u;
}

fn storage_replace(pixel: u32, cursor: u32, entry: Packed) {
    max_array_publish(pixel, cursor, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return max_array_cursor(frame.k - kept_counts_load(pixel));
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return max_array_cursor(cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return max_array_read(pixel, cursor);
}

/// Replaces the fragment of slot 0: `entry` joins slots 1 ... k-1, and the worst of them all moves to slot 0.
fn max_array_replace_worst(pixel: u32, entry: Packed) {
    var worst = entry;
    var worst_slot = 0u;
    for (var slot = 1u; slot < allocation_slots(pixel); slot++) {
        let resident = max_array_read(pixel, slot);
        if better(worst, resident) {
            worst = resident;
            worst_slot = slot;
        }
    }
    max_array_publish(pixel, 0u, worst);
    if worst_slot != 0u {
        max_array_write(pixel, worst_slot, entry);
    }
}

fn max_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

/// Writes an entry of slots 1 ... k-1, which only the critical section reads.
fn max_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

/// Writes an entry of slot 0, whose key is read outside of the critical section.
fn max_array_publish(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_publish(slot, pixel, entry.key);
}

fn max_array_cursor(slot: u32) -> u32 {
    return select(END, slot, slot < frame.k);
}
