// Multi-layer alpha blending (Salvi & Vaidyanathan 2014): where a fragment is displaced, it and the farthest of
// those that stay become one. The key and the other attributes are those of the nearer, the colour is the nearer's
// over the farther's. The storage has put a new fragment in before it hands the displaced one over, so that the
// two farthest of k + 1 merge.
//
// Invariants. 1 - alpha of a merged colour is the product of both: the pixel's transmittance stays, whatever the
// order of arrival, but for the rounding of its format. Keys are never changed, so they are those of the k best,
// and a bound that rests on keys stays sound. A colour is merged into the worst entry alone, which is the next to
// be displaced: the k - 1 nearest stay as they came.
//
// The farthest entry's colour does depend on the order of arrival: what comes late, and lies between fragments
// that are merged by then, goes behind them. Among equal keys it depends on it, and on the storage, which of them
// stays, because a merged colour is compared like any other word.
//
// What is lost outside of the critical section (a lock that was not free in time) is counted and not merged;
// nothing is turned away earlier. Memory: none.

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
    if reason == DISPLACED {
        let farthest = storage_worst(pixel);
        storage_replace(pixel, farthest, merge_over(storage_read(pixel, farthest), lost));
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
