// Lists per depth bucket (D13 sec. 3.1.4, BUN-LL): the depths of each pixel are cut into BUCKETS equal parts, and each
// part has a list of its own through one pool of nodes. The resolve pass goes from the nearest bucket to the farthest,
// so a fragment is never put before one of another bucket: a sort by insertion moves it past those of its own alone.
//
// Invariant: the bucket of a fragment never falls as its depth rises, whatever the range of the pixel is. Depths are
// cut down to whole parts of 2^24 and compared as whole numbers, on every device alike. Links are written by their
// owner alone and read only after the pass.
//
// The paper takes the range from the scene's box, splits it into five, and gives every bucket a pool of its own, of
// which those of rare buckets stay empty. Here a pass over the scene itself finds each pixel's range, which is the
// tightest, and all buckets share one pool.
//
// Memory: entry_words + 1 words per fragment, BUCKETS + 2 per pixel. (The paper's 3f+8 has a counter per bucket where
// this has two words of range per pixel and one counter for all pixels.)

const BUCKETS = 5u;

/// The words of a range. The nearest key is stored with its bits flipped, so that both grow from 0, the empty range.
const NEAREST = 0u;
const FARTHEST = 1u;

fn storage_survey(pixel: u32, entry: Packed) {
    ranges_atomic_max(NEAREST, pixel, ~entry.key);
    ranges_atomic_max(FARTHEST, pixel, entry.key);
}

fn storage_insert(pixel: u32, entry: Packed) {
    let node = pool_atomic_add(1u);
    if node >= frame.fragments {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    nodes_store(node, entry);
    links_store(node, heads_atomic_exchange(bucket_lists_bucket(pixel, entry.key), pixel, node + 1u));
}

fn storage_first(pixel: u32) -> u32 {
    return bucket_lists_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    let link = links_load(cursor);
    if link != 0u {
        return link - 1u;
    }
    return bucket_lists_seek(pixel, bucket_lists_bucket(pixel, nodes_load(cursor).key) + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}

/// The first node of the nearest bucket from `bucket` on that has one.
fn bucket_lists_seek(pixel: u32, bucket: u32) -> u32 {
    for (var cursor = bucket; cursor < BUCKETS; cursor++) {
        let head = heads_load(cursor, pixel);
        if head != 0u {
            return head - 1u;
        }
    }
    return END;
}

/// The bucket of a key. One outside the pixel's range counts as its nearer or its farther end.
fn bucket_lists_bucket(pixel: u32, key: u32) -> u32 {
    let begin = bucket_lists_depth(~ranges_load(NEAREST, pixel));
    let span = max(bucket_lists_depth(ranges_load(FARTHEST, pixel)), begin) - begin + 1u;
    let beyond = max(bucket_lists_depth(key), begin) - begin;
    return min(beyond, span - 1u) * BUCKETS / span;
}

/// The depth of a key in whole parts of 2^24. Beyond 1 it counts as 1.
fn bucket_lists_depth(key: u32) -> u32 {
    return u32(bitcast<f32>(min(key, 0x3f800000u)) * 16777216.0);
}
