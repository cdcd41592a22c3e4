// A list per pixel that is sorted at every instant (Yu et al. 2012; K15 sec. 2, KB-LL). A fragment walks the list from
// the best node past all nodes that are no worse, and inserts itself there by one compare-exchange. If the exchange
// fails, it continues from the same node. A fragment with k nodes ahead of it is dropped.
//
// Invariant: the list only grows; nodes are never moved or freed, and only their links change. A link is only replaced
// by the link of a node that belongs between its two ends. So nodes ahead of a fragment stay ahead of it, the k best
// fragments are the first k nodes at the end of the pass, and an unchanged link value means an unchanged list there
// (no ABA).
//
// A node is stored before it is linked, and a link is read before the node: fences enforce both. Plain WGSL has no
// fence in fragment shaders (tier T4). Insertion is lock-free but not wait-free: a failed compare-exchange means
// another fragment succeeded. Attempts are bounded, and a fragment that times out is counted; its node stays unused.
//
// Memory: entry_words + 1 words per linked fragment, 1 per pixel. (The papers' two sentinel nodes, 6 words per pixel,
// are one head word here, and a dropped fragment takes no node.)

/// The link to no node; links are node indices plus one.
const NO_NODE = 0u;

/// The number of nodes that the resolve pass has read since the first.
var<private> nodes_read: u32;
/// Whether the resolve pass has reached the end before. A sort may read the list again, but losses are counted once.
var<private> end_reached: bool;

fn storage_insert(pixel: u32, entry: Packed) {
    // The exchange of a helper invocation has no effect: it would use all attempts.
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
    on_lost(pixel, entry, TIMED_OUT);
}

fn storage_first(pixel: u32) -> u32 {
    nodes_read = 1u;
    // NO_NODE wraps around to END.
    return bounded_walk_first(heads_load(pixel) - 1u, frame.fragments);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    let next = bounded_walk_next(links_load(cursor) - 1u, frame.fragments);
    if nodes_read < frame.k {
        nodes_read += 1u;
        return next;
    }
    if end_reached {
        return END;
    }
    end_reached = true;
    // Better fragments were inserted after these.
    for (var beyond = next; beyond != END; beyond = bounded_walk_next(links_load(beyond) - 1u, frame.fragments)) {
        on_lost(pixel, nodes_load(beyond), DISPLACED);
    }
    return END;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return nodes_load(cursor);
}

/// Returns the link after `previous`; for NO_NODE, the head of the pixel's list.
fn ordered_list_link(pixel: u32, previous: u32) -> u32 {
    if previous == NO_NODE {
        return heads_hint(pixel);
    }
    return links_hint(previous - 1u);
}

fn ordered_list_exchange(pixel: u32, previous: u32, expected: u32, node: u32) -> bool {
    if previous == NO_NODE {
        return heads_atomic_compare_exchange(pixel, expected, node);
    }
    return links_atomic_compare_exchange(previous - 1u, expected, node);
}
