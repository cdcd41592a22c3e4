// Z3 (Jouppi & Chang 1999): if a pixel has k + 1 fragments, the two neighbours that are closest in depth are merged.
// Of equally close pairs the farther is merged, so that the front stays exact. The depth and the other attributes are
// those of the nearer fragment, and the colour is the nearer over the farther; fragments behind move up by one slot.
//
// Invariants. The storage passes the farthest of k + 1 fragments to this row when all k slots are full, in depth
// order. So the pairs are neighbouring slots, and the last slot with the displaced fragment. Slots stay in depth
// order. The nearest fragment's depth does not change. 1 - alpha of a merged colour is the product of both, so the
// pixel's transmittance does not depend on the order of arrival, except for the rounding of its format.
//
// The kept keys are not those of the k best, and the last key may increase: a bound based on them would cull fragments
// that must be merged, so nothing may be culled. Which pairs merge, and which fragments later lie between them,
// depends on the order of arrival. Fragments lost outside the critical section (a timeout at a lock) are counted and
// not merged. Memory: none.

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
    if reason == DISPLACED {
        merge_closest_at(pixel, merge_closest_find(pixel, lost), lost);
    }
}

fn on_culled(pixel: u32, lost: Packed) {
    count_event(CULLED);
}

fn overflow_is_empty(pixel: u32) -> bool {
    return true;
}

fn overflow_finish(pixel: u32, color: vec4<f32>) -> vec4<f32> {
    return color;
}

/// Returns the cursor of the nearer fragment of the closest pair; `lost` follows the last slot.
fn merge_closest_find(pixel: u32, lost: Packed) -> u32 {
    var cursor = storage_first(pixel);
    var closest = cursor;
    var least = -1.0;
    while cursor != END {
        let next = storage_next(pixel, cursor);
        let gap = fragment_unpack(merge_closest_behind(pixel, next, lost)).depth
            - fragment_unpack(storage_read(pixel, cursor)).depth;
        if least < 0.0 || gap <= least {
            least = gap;
            closest = cursor;
        }
        cursor = next;
    }
    return closest;
}

/// Merges the fragment at `front` with the next one. The fragments behind them, `lost` last, move up by one slot.
fn merge_closest_at(pixel: u32, front: u32, lost: Packed) {
    var next = storage_next(pixel, front);
    let both = merge_over(storage_read(pixel, front), merge_closest_behind(pixel, next, lost));
    storage_replace(pixel, front, both);
    while next != END {
        let cursor = next;
        next = storage_next(pixel, cursor);
        storage_replace(pixel, cursor, merge_closest_behind(pixel, next, lost));
    }
}

/// Returns the fragment at a cursor, or `lost` past the last.
fn merge_closest_behind(pixel: u32, cursor: u32, lost: Packed) -> Packed {
    if cursor == END {
        return lost;
    }
    return storage_read(pixel, cursor);
}
