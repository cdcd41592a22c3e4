// Depth partitioning (B06 sec. 4.2): the depths from NEAR_MILLIONTHS to FAR_MILLIONTHS are divided into k equal
// ranges, and each range keeps its nearest fragment, in one pass. A range includes its lower end and excludes its
// upper end; depths before the first or beyond the last range belong to that range. Boundaries are exact: depths are
// rounded down to whole millionths and compared as integers, equally on every device.
//
// Invariant: a slot only changes to a better fragment, inside the critical section, and holds only fragments of its
// range. No single key bounds all ranges, so there is no early cull.
//
// Memory: k * entry_words words per pixel, and the lock's.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    let slot = depth_ranges_slot(entry);
    let resident = depth_ranges_read(pixel, slot);
    if !better(entry, resident) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    if resident.key != EMPTY {
        on_lost(pixel, resident, DISPLACED);
    }
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

fn storage_first(pixel: u32) -> u32 {
    return depth_ranges_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return depth_ranges_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return depth_ranges_read(pixel, cursor);
}

/// Returns the range of the fragment's depth, which is its key.
fn depth_ranges_slot(entry: Packed) -> u32 {
    let depth = u32(min(bitcast<f32>(entry.key), 1.0) * 1000000.0);
    let beyond = max(depth, NEAR_MILLIONTHS) - NEAR_MILLIONTHS;
    let span = max(FAR_MILLIONTHS, NEAR_MILLIONTHS + 1u) - NEAR_MILLIONTHS;
    return min(min(beyond, span) * frame.k / span, frame.k - 1u);
}

fn depth_ranges_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

/// Returns the first range from `slot` on that holds a fragment.
fn depth_ranges_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
