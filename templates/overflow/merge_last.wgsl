// Multi-layer alpha blending (Salvi & Vaidyanathan 2014): a displaced fragment is merged with the farthest of the kept
// ones. The key and the other attributes are those of the nearer fragment, and the colour is the nearer over the
// farther. The storage inserts a new fragment before it passes the displaced one to this row, so the two farthest of k
// + 1 are merged.
//
// Invariants. 1 - alpha of a merged colour is the product of both, so the pixel's transmittance does not depend on the
// order of arrival, except for the rounding of its format. Keys never change, so they are those of the k best, and a
// bound on keys stays sound. Colours are only merged into the worst entry, which is displaced next: the k - 1 nearest
// are not changed.
//
// The farthest entry's colour depends on the order of arrival: a late fragment that lies between fragments merged
// before goes behind them. Among equal keys, the kept fragment depends on the order of arrival and on the storage,
// because a merged colour is compared like any other word.
//
// Fragments lost outside the critical section (a timeout at a lock) are counted and not merged; nothing is culled.
// Memory: none.

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
