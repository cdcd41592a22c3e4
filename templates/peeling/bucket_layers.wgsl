// Bucket peeling (Liu et al. 2009; Vasilakis & Fudos 2013, D13 sec. 3.1.4: BUN). The depth range of each pixel is
// divided into PEELING_BUCKETS equal parts, and each part is peeled from both sides, as both_sides does for the whole
// range: an iteration stores up to two layers per bucket. If depths are spread evenly, D layers take about
// D / (2 PEELING_BUCKETS) iterations; the fullest bucket decides.
//
// A pass over the scene finds the range of each pixel. The first iteration stores nothing: it finds the nearest and the
// farthest layer of every bucket.
//
// Invariant: the keys of a bucket's two layers are the least and the greatest of the bucket that no earlier iteration
// has stored. If they are equal, the layer is one of the front. Keys of the back are inverted: minima find both. Every
// pass finds the same bucket for a key.
//
// Memory: 12 PEELING_BUCKETS + 2 words per pixel, and one word.

/// The sides of a bucket, and the ends of the range.
const PEELING_FRONT = 0u;
const PEELING_BACK = 1u;

fn peeling_find_first(pixel: u32, key: u32) {
    if key < range_load(PEELING_FRONT, pixel) {
        range_atomic_min(PEELING_FRONT, pixel, key);
    }
    if ~key < range_load(PEELING_BACK, pixel) {
        range_atomic_min(PEELING_BACK, pixel, ~key);
    }
}

fn peeling_bucket(pixel: u32, key: u32) -> u32 {
    return depth_bucket(key, range_load(PEELING_FRONT, pixel), ~range_load(PEELING_BACK, pixel), PEELING_BUCKETS);
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    let pixel = pixel_index(position);
    let key = fragment_pack(fragment).key;
    return !peeling_takes(pixel, peeling_bucket(pixel, key), key);
}

/// Returns whether this iteration stores a fragment of this key. A key of 0 inverted is EMPTY, which is also the key of
/// a bucket without layers: nothing is behind its front.
fn peeling_takes(pixel: u32, bucket: u32, key: u32) -> bool {
    let front = layer_keys_load(PEELING_FRONT, bucket, pixel);
    return key == front || (key > front && ~key == layer_keys_load(PEELING_BACK, bucket, pixel));
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    let pixel = pixel_index(position);
    let key = fragment_pack(fragment).key;
    let bucket = peeling_bucket(pixel, key);
    let is_between = key > layer_keys_load(PEELING_FRONT, bucket, pixel)
        && ~key > layer_keys_load(PEELING_BACK, bucket, pixel);
    if frame.iteration == 0u || is_between {
        peeling_find_next(pixel, bucket, key);
    }
    return peeling_takes(pixel, bucket, key);
}

fn peeling_find_next(pixel: u32, bucket: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    if key < next_keys_load(PEELING_FRONT, bucket, pixel)
        && next_keys_atomic_min(PEELING_FRONT, bucket, pixel, key) == EMPTY {
        remaining_store(1u);
    }
    if ~key < next_keys_load(PEELING_BACK, bucket, pixel) {
        next_keys_atomic_min(PEELING_BACK, bucket, pixel, ~key);
    }
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    let bucket = peeling_bucket(pixel, entry.key);
    let is_front = entry.key == layer_keys_load(PEELING_FRONT, bucket, pixel);
    return 2u * bucket + select(PEELING_BACK, PEELING_FRONT, is_front);
}

fn peeling_reached(pixel: u32) -> u32 {
    for (var bucket = 0u; bucket < PEELING_BUCKETS; bucket++) {
        let key = next_keys_load(PEELING_FRONT, bucket, pixel);
        if key != EMPTY {
            return key;
        }
    }
    return EMPTY;
}
