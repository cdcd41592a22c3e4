// A list per pixel that is in order at every instant (Yu et al. 2012; K15 sec. 2, KB-LL). A fragment goes along the
// list from the best on, past all that are no worse, and is linked in there by one compare and exchange. If another
// came first, it looks again from the same node. Once k nodes are ahead of it, it is dropped.
//
// Invariant: the list only grows, nodes never move, are never freed and never change but for their link; a link is
// only ever replaced by that of a node which belongs between its two ends. So what is ahead of a fragment stays ahead
// of it, the k best are the first k nodes at the end, and a link that is seen unchanged is unchanged (no ABA).
//
// A node is stored before it is linked, and a link is read before the node: the fences keep it so. Plain WGSL has
// none in a fragment shader (tier T4). Tries are bounded, because each failure is another's success, but no one
// promises that one's own turn comes; a fragment that is given up is counted, and its node stays unused.
//
// Memory: entry_words + 1 words per fragment that is linked, 1 per pixel. (The papers' two sentinel nodes, 6 words
// per pixel, are a head of one word here, and a fragment that is dropped takes no node.)

/// No node, as links are stored: plus one.
const NO_NODE = 0u;

/// Nodes that the resolve pass has read, since it began with the first.
var<private> nodes_read: u32;
/// Whether it has been at the end: a sort may read the list again, and what is lost is counted once.
var<private> end_reached: bool;

fn storage_insert(pixel: u32, entry: Packed) {
    // A helper lane's exchange has no effect: it would try to the end.
    if is_helper_lane() {
        return;
    }
    var node = NO_NODE;
    var previous = NO_NODE;
    var ahead = 0u;
    for (var attempt = 0u; attempt < LINK_TRIES; attempt++) {
        var next = ordered_list_link(pixel, previous);
        while next != NO_NODE {
            memory_fence();
            if better(entry, nodes_load(next - 1u)) {
                break;
            }
            ahead++;
            if ahead == frame.k {
                on_lost(pixel, entry, DISPLACED);
                return;
            }
            previous = next;
            next = ordered_list_link(pixel, previous);
        }
        if node == NO_NODE {
            node = pool_atomic_add(1u) + 1u;
            if node > frame.fragments {
                on_lost(pixel, entry, POOL_EXHAUSTED);
                return;
            }
            nodes_store(node - 1u, entry);
        }
        links_store(node - 1u, next);
        memory_fence();
        if ordered_list_exchange(pixel, previous, next, node) {
            return;
        }
    }
    on_lost(pixel, entry, SPIN_EXHAUSTED);
}

fn storage_first(pixel: u32) -> u32 {
    nodes_read = 1u;
    // No node becomes END.
    return heads_load(pixel) - 1u;
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    let next = links_load(cursor);
    if nodes_read < frame.k {
        nodes_read += 1u;
        return next - 1u;
    }
    if end_reached {
        return END;
    }
    end_reached = true;
    // Better fragments came after these were linked.
    for (var beyond = next; beyond != NO_NODE; beyond = links_load(beyond - 1u)) {
        on_lost(pixel, nodes_load(beyond - 1u), DISPLACED);
    }
    return END;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}

/// The node after `previous`, which is the pixel's head where there is no node.
fn ordered_list_link(pixel: u32, previous: u32) -> u32 {
    if previous == NO_NODE {
        return heads_load(pixel);
    }
    return links_load(previous - 1u);
}

fn ordered_list_exchange(pixel: u32, previous: u32, expected: u32, node: u32) -> bool {
    if previous == NO_NODE {
        return heads_atomic_compare_exchange(pixel, expected, node);
    }
    return links_atomic_compare_exchange(previous - 1u, expected, node);
}
