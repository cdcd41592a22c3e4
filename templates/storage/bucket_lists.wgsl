// Lists per depth bucket (D13 sec. 3.1.4, BUN-LL). The depth range of each pixel is divided into BUCKETS equal parts,
// and each part has a list of its own; all lists share one pool of nodes. The resolve pass reads the buckets from the
// nearest to the farthest, so an insertion sort moves a fragment only past fragments of the same bucket.
//
// Invariant: the bucket of a fragment never decreases as its depth increases, whatever the range of the pixel is. Only
// the owner of a link writes it, and links are read only after the pass.
//
// The paper takes the range from the bounding box of the scene, splits it into five and gives every bucket a pool of
// its own; the pools of rare buckets stay empty. Here a pass over the scene finds the tightest range of each pixel,
// and all buckets share one pool.
//
// Memory: entry_words + 1 words per fragment, BUCKETS + 2 per pixel. (The paper's 3f+8 has a counter per bucket; this
// has two words of range per pixel and one counter for all pixels.)

const BUCKETS = 5u;

/// The words of a range. The nearest key is stored with its bits inverted, so that both words grow from 0, the empty
/// range.
const NEAREST = 0u;
const FARTHEST = 1u;

fn storage_prepass(pixel: u32, entry: Packed) {
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
    return bounded_walk_first(bucket_lists_seek(pixel, 0u), frame.fragments);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    let link = links_load(cursor);
    if link != 0u {
        return bounded_walk_next(link - 1u, frame.fragments);
    }
    let bucket = bucket_lists_bucket(pixel, nodes_load(cursor).key);
    return bounded_walk_next(bucket_lists_seek(pixel, bucket + 1u), frame.fragments);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}

/// Returns the first node of the nearest non-empty bucket from `bucket` on.
fn bucket_lists_seek(pixel: u32, bucket: u32) -> u32 {
    for (var cursor = bucket; cursor < BUCKETS; cursor++) {
        let head = heads_load(cursor, pixel);
        if head != 0u {
            return head - 1u;
        }
    }
    return END;
}

fn bucket_lists_bucket(pixel: u32, key: u32) -> u32 {
    return depth_bucket(key, ~ranges_load(NEAREST, pixel), ranges_load(FARTHEST, pixel), BUCKETS);
}
