// Occupancy culling (Vasilakis & Papaioannou 2015): rejects fragments that are certainly not among the k best, for any
// order of arrival. Two geometry passes precede the store pass. The first finds the range of a pixel's keys. The
// second divides it into 32 * OCCUPANCY_WORDS buckets and sets the bit of every fragment's bucket. The bucket of the
// k-th set bit then ends the range, and fragments beyond it are rejected.
//
// Invariant: buckets are in the order of keys, and up to the end of the narrowed range k of them hold a fragment. So
// at least k fragments, with different keys, are better than any rejected one. If fewer than k bits are set, the range
// is not narrowed. Fragments in the last bucket pass, and so do equal keys.
//
// All decisions use integers, so every pass and device agrees: keys are divided, not depths. Within a binade of depth
// (0.5 to 1, 0.25 to 0.5, ...) the buckets are the paper's uniform intervals; over several binades, nearer ones are
// finer. Any criterion has keys. Buckets distinguish keys by the upper 19 bits of their distance from the nearest.
//
// Memory: OCCUPANCY_WORDS + 2 words per pixel; the paper needs d + 3, one of them for the bound. The k-buffer's words
// cannot be shared: they have been reset by then.

/// Words of a pixel in `occupancy`: the complement of its nearest key, so that 0 means none; its farthest key, or after
/// narrowing the last key that can be kept; then the bits.
const NEAREST = 0u;
const FARTHEST = 1u;
const BITS = 2u;

const BUCKETS = 32u * OCCUPANCY_WORDS;

fn cull_key_range(pixel: u32, entry: Packed) {
    occupancy_atomic_max(NEAREST, pixel, ~entry.key);
    occupancy_atomic_max(FARTHEST, pixel, entry.key);
}

fn cull_occupancy_map(pixel: u32, entry: Packed) {
    let nearest = ~occupancy_load(NEAREST, pixel);
    let farthest = occupancy_load(FARTHEST, pixel);
    let span = farthest - nearest;
    // The key of a helper invocation can be outside the range; the index must stay inside the memory.
    let step = (min(max(entry.key, nearest), farthest) - nearest) >> occupancy_shift(span);
    let bucket = step * BUCKETS / occupancy_steps(span);
    occupancy_atomic_or(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));
}

fn cull_occupancy_bound(pixel: u32) {
    occupancy_store(FARTHEST, pixel, cull_last(pixel));
}

fn cull_last(pixel: u32) -> u32 {
    var left = frame.k;
    for (var word = 0u; word < OCCUPANCY_WORDS; word++) {
        var bits = occupancy_load(BITS + word, pixel);
        let count = countOneBits(bits);
        if count >= left {
            // Each step clears the lowest bit (Kernighan & Ritchie 1988, ex. 2-9).
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

/// Returns the last key of a bucket: the key before the first step of the next bucket.
fn occupancy_end(pixel: u32, bucket: u32) -> u32 {
    let nearest = ~occupancy_load(NEAREST, pixel);
    let span = occupancy_load(FARTHEST, pixel) - nearest;
    let next_step = ((bucket + 1u) * occupancy_steps(span) + BUCKETS - 1u) / BUCKETS;
    // Past the last step the shift wraps around to 0, and the subtraction to the greatest word.
    let last = (next_step << occupancy_shift(span)) - 1u;
    return nearest + min(last, span);
}

/// Returns the shift that reduces distances from the nearest key to 19-bit steps; steps times buckets fit in a word.
fn occupancy_shift(span: u32) -> u32 {
    return 13u - min(countLeadingZeros(span), 13u);
}

/// Returns the number of steps in the range, at least one.
fn occupancy_steps(span: u32) -> u32 {
    return (span >> occupancy_shift(span)) + 1u;
}
