// Turns away what is worse than the worst kept fragment, before the critical section (K15 sec. 3.2, Fig. 7). The
// bound may be read at any time: it only ever falls, and never below the k-th best key. Equal keys go in, because
// ties are decided among whole entries, inside.

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return entry.key > storage_bound(pixel);
}
