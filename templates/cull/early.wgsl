// Rejects fragments that are worse than the worst kept fragment, before the critical section (K15 sec. 3.2, Fig. 7).
// The bound can be read at any time: it only decreases, and never below the k-th best key. Fragments with an equal key
// pass, because ties are resolved inside, between whole entries.

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return entry.key > storage_bound(pixel);
}
