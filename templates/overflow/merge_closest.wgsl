// Z3 (Jouppi & Chang 1999): where a pixel has k + 1 fragments, the two neighbours that are closest in depth become
// one. Of pairs equally close it is the farther, so that the front stays exact. The depth and the other attributes
// are those of the nearer, the colour is the nearer's over the farther's; those behind move up.
//
// Invariants. The storage hands over the farthest of k + 1 when all k slots are taken, in the order of depth: so
// the pairs are neighbouring slots, and the last slot with what is handed over. Slots stay in that order. The
// nearest fragment's depth stays. 1 - alpha of a merged colour is the product of both: the pixel's transmittance
// stays, whatever the order of arrival, but for the rounding of its format.
//
// The keys that stay are not those of the k best, and the last may grow: a bound that rests on them would turn
// fragments away that merge, so nothing may be turned away. Which pairs merge, and what lies between them later,
// depends on the order of arrival. What is lost outside of the critical section (a lock that was not free in time)
// is counted and not merged. Memory: none.

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

/// The cursor of the nearer of the closest pair; `lost` lies behind the last slot.
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

/// Makes one of the fragment at `place` and the next behind it. Those behind that one move up by a slot, `lost` last.
fn merge_closest_at(pixel: u32, place: u32, lost: Packed) {
    var next = storage_next(pixel, place);
    let both = merge_over(storage_read(pixel, place), merge_closest_behind(pixel, next, lost));
    storage_replace(pixel, place, both);
    while next != END {
        let cursor = next;
        next = storage_next(pixel, cursor);
        storage_replace(pixel, cursor, merge_closest_behind(pixel, next, lost));
    }
}

/// The fragment at a cursor, or `lost` behind the last.
fn merge_closest_behind(pixel: u32, cursor: u32, lost: Packed) -> Packed {
    if cursor == END {
        return lost;
    }
    return storage_read(pixel, cursor);
}
