// Occupancy culling (Vasilakis & Papaioannou 2015): turns away what is surely not among the k best, whatever the order
// of arrival. Two geometry passes go before the store pass. The first finds the range of a pixel's keys; the second
// cuts it into 32 * OCCUPANCY_WORDS buckets and sets the bit of every fragment's bucket. Then the bucket of the k-th
// bit ends the range: what lies beyond is turned away.
//
// Invariant: buckets are in the order of keys, and k of them up to the end of the narrowed range hold a fragment. So at
// least k fragments, of different keys, are better than any that is turned away. Where fewer than k bits are set, the
// range stays whole. What shares the last bucket goes in, equal keys with it.
//
// Whole numbers alone decide, the same in every pass and on every device: keys are cut, not depths. Within a binade of
// depth (0.5 to 1, 0.25 to 0.5, ...) those are the paper's uniform intervals; over several, nearer ones are finer. Any
// criterion has keys. Keys are told apart by the upper 19 bits of their distance from the nearest.
//
// Memory: OCCUPANCY_WORDS + 2 words per pixel; the paper's d + 3, without a word for the bound. The k-buffer's words
// are not shared: they have been reset by then.

/// Words of a pixel in `occupancy`: the complement of its nearest key, so that 0 is none; its farthest key, once it is
/// narrowed the last that may stay; then the bits.
const NEAREST = 0u;
const FARTHEST = 1u;
const BITS = 2u;

const BUCKETS = 32u * OCCUPANCY_WORDS;

fn cull_measure(pixel: u32, entry: Packed) {
    occupancy_atomic_max(NEAREST, pixel, ~entry.key);
    occupancy_atomic_max(FARTHEST, pixel, entry.key);
}

fn cull_occupy(pixel: u32, entry: Packed) {
    let nearest = ~occupancy_load(NEAREST, pixel);
    let farthest = occupancy_load(FARTHEST, pixel);
    let span = farthest - nearest;
    // A helper lane's key may lie outside of the range, and must not lead outside of memory.
    let step = (min(max(entry.key, nearest), farthest) - nearest) >> occupancy_shift(span);
    let bucket = step * BUCKETS / occupancy_steps(span);
    occupancy_atomic_or(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));
}

fn cull_narrow(pixel: u32) {
    occupancy_store(FARTHEST, pixel, cull_last(pixel));
}

fn cull_last(pixel: u32) -> u32 {
    var left = frame.k;
    for (var word = 0u; word < OCCUPANCY_WORDS; word++) {
        var bits = occupancy_load(BITS + word, pixel);
        let count = countOneBits(bits);
        if count >= left {
            // Each step takes off the lowest bit (Kernighan & Ritchie 1988, ex. 2-9).
            for (; left > 1u; left--) {
                bits &= bits - 1u;
            }
            return occupancy_end(pixel, 32u * word + countTrailingZeros(bits));
        }
        left -= count;
    }
    return occupancy_load(FARTHEST, pixel);
}

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return entry.key > occupancy_load(FARTHEST, pixel);
}

/// The last key of a bucket, which is the one before the first step of the next.
fn occupancy_end(pixel: u32, bucket: u32) -> u32 {
    let nearest = ~occupancy_load(NEAREST, pixel);
    let span = occupancy_load(FARTHEST, pixel) - nearest;
    let next_step = ((bucket + 1u) * occupancy_steps(span) + BUCKETS - 1u) / BUCKETS;
    // Behind the last step of all words the shift wraps to 0, and what is before it to the last word.
    let last = (next_step << occupancy_shift(span)) - 1u;
    return nearest + min(last, span);
}

/// By how many bits distances from the nearest key are cut to steps: to 19 bits, which times the buckets are a word.
fn occupancy_shift(span: u32) -> u32 {
    return 13u - min(countLeadingZeros(span), 13u);
}

/// Steps in the range, at least one.
fn occupancy_steps(span: u32) -> u32 {
    return (span >> occupancy_shift(span)) + 1u;
}
