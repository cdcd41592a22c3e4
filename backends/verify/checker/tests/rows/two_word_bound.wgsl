// Wrong on purpose: the criterion of the worst fragment is stored in two words, and the cull reads one after the other.

fn storage_reset(pixel: u32) {
    keys_store(0u, pixel, EMPTY);
    kept_counts_store(pixel, 0u);
    halves_store(0u, pixel, EMPTY >> 16u);
    halves_store(1u, pixel, EMPTY & 0xffffu);
}

fn storage_bound(pixel: u32) -> u32 {
    return (halves_load(0u, pixel) << 16u) | halves_load(1u, pixel);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let kept_before = kept_counts_load(pixel);
    if kept_before + 1u < frame.k {
        max_array_write(pixel, frame.k - 1u - kept_before, entry);
        kept_counts_store(pixel, kept_before + 1u);
        return;
    }
    if kept_before < frame.k {
        kept_counts_store(pixel, frame.k);
    } else {
        let worst = max_array_read(pixel, 0u);
        if !better(entry, worst) {
            on_lost(pixel, entry, DISPLACED);
            return;
        }
        on_lost(pixel, worst, DISPLACED);
    }
    max_array_replace_worst(pixel, entry);
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

/// Writes `entry` to slots 1 ... k-1, and the worst of all entries to slot 0, whose fragment is displaced.
fn max_array_replace_worst(pixel: u32, entry: Packed) {
    var worst = entry;
    var worst_slot = 0u;
    for (var slot = 1u; slot < frame.k; slot++) {
        let resident = max_array_read(pixel, slot);
        if better(worst, resident) {
            worst = resident;
            worst_slot = slot;
        }
    }
    max_array_write(pixel, 0u, worst);
    if worst_slot != 0u {
        max_array_write(pixel, worst_slot, entry);
    }
}

fn max_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

fn max_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
    if slot == 0u {
        halves_store(0u, pixel, entry.key >> 16u);
        halves_store(1u, pixel, entry.key & 0xffffu);
    }
}

fn max_array_cursor(slot: u32) -> u32 {
    return select(END, slot, slot < frame.k);
}
