// A list per pixel through one pool of nodes (Yang et al. 2010). A fragment takes the next node of the pool and makes
// it the head of its pixel's list by one atomic exchange. Only the owner of a link writes it, and links are read only
// after the pass, so every list is complete for any order of arrival. Links are stored plus one, so that memory
// cleared to 0 is empty lists.
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
    // 0, the empty list, wraps around to END.
    return bounded_walk_first(heads_load(pixel) - 1u, frame.fragments);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return bounded_walk_next(links_load(cursor) - 1u, frame.fragments);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}
