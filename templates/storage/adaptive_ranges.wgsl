// Adaptive bucket peeling (Liu et al. 2009; Vasilakis & Fudos 2013, D13 sec. 3.1.4: BAD; the papers leave the cuts
// open). Four draws of the scene keep up to k fragments of each pixel, one per part of its depth range, where the parts
// follow the fragments: the first draw finds the range, the second divides it into 32 * OCCUPANCY_WORDS equal buckets
// and marks those that fragments are in, the third finds the least key of each part, and the fourth stores the fragment
// that has it. A part is one marked bucket; the k-th takes all the others.
//
// Invariant: parts are in the order of depth, and every draw finds the same part for a key. What a draw finds is read
// in later draws, so the order of fragments only decides which of several equal keys is kept. The others are counted.
//
// Memory: k * entry_words + 2 * OCCUPANCY_WORDS + 2 words per pixel.

/// The ends of the range. The key of the nearest is inverted, so that both words grow from 0, the empty range.
const NEAREST = 0u;
const FARTHEST = 1u;

fn storage_prepass(pixel: u32, entry: Packed) {
    if PREPASS == 0u {
        ranges_atomic_max(NEAREST, pixel, ~entry.key);
        ranges_atomic_max(FARTHEST, pixel, entry.key);
    }
    if PREPASS == 1u {
        adaptive_ranges_mark(pixel, adaptive_ranges_bucket(pixel, entry.key));
    }
    if PREPASS == 2u {
        adaptive_ranges_lower(adaptive_ranges_part(pixel, entry.key), pixel, entry.key);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    let part = adaptive_ranges_part(pixel, entry.key);
    if entry.key != keys_load(part, pixel) {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    let bit = 1u << (part % 32u);
    if (claims_atomic_or(part / 32u, pixel, bit) & bit) != 0u {
        on_lost(pixel, entry, EQUAL_KEYS);
        return;
    }
    entries_store(part, pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return adaptive_ranges_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return adaptive_ranges_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

/// Parts are used from the first on.
fn adaptive_ranges_cursor(pixel: u32, part: u32) -> u32 {
    if part >= frame.k {
        return END;
    }
    return select(END, part, keys_load(part, pixel) != EMPTY);
}

fn adaptive_ranges_mark(pixel: u32, bucket: u32) {
    let bit = 1u << (bucket % 32u);
    if (occupancy_load(bucket / 32u, pixel) & bit) == 0u {
        occupancy_atomic_or(bucket / 32u, pixel, bit);
    }
}

fn adaptive_ranges_lower(part: u32, pixel: u32, key: u32) {
    // Most fragments are behind another one: reading is cheaper than a minimum that changes nothing.
    if key < keys_load(part, pixel) {
        keys_atomic_min(part, pixel, key);
    }
}

/// Returns the part of a key: the number of marked buckets before its own.
fn adaptive_ranges_part(pixel: u32, key: u32) -> u32 {
    let bucket = adaptive_ranges_bucket(pixel, key);
    var part = countOneBits(occupancy_load(bucket / 32u, pixel) & ((1u << (bucket % 32u)) - 1u));
    for (var word = 0u; word < bucket / 32u; word++) {
        part += countOneBits(occupancy_load(word, pixel));
    }
    return min(part, frame.k - 1u);
}

fn adaptive_ranges_bucket(pixel: u32, key: u32) -> u32 {
    let nearest = ~ranges_load(NEAREST, pixel);
    return depth_bucket(key, nearest, ranges_load(FARTHEST, pixel), 32u * OCCUPANCY_WORDS);
}
