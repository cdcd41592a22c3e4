// A list per pixel through one pool of nodes (Yang et al. 2010). A fragment takes the next node of the pool, then
// becomes the head of its pixel's list by one exchange. Links are written by their owner alone and read only after
// the pass, so the lists are whole whatever the order. They are stored plus one: memory cleared to 0 is a frame of
// empty lists.
//
// Memory: entry_words + 1 words per fragment, 1 per pixel.

fn storage_insert(pixel: u32, entry: Packed) {
    let node = pool_atomic_add(1u);
    if node >= frame.fragments {
        on_lost(pixel, entry, POOL_EXHAUSTED);
        return;
    }
    nodes_store(node, entry);
    links_store(node, heads_atomic_exchange(pixel, node + 1u));
}

fn storage_first(pixel: u32) -> u32 {
    // 0, the empty list, becomes END.
    return heads_load(pixel) - 1u;
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return links_load(cursor) - 1u;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}
