// Walks along links in memory. The end of a walk does not depend on the links: no walk visits more entries than memory
// has, and none leaves memory.

/// The number of entries that the walk may still visit.
var<private> bounded_walk_left: u32;

/// Begins a walk over memory of `size` entries. Returns `cursor`, or END if it is not in memory.
fn bounded_walk_first(cursor: u32, size: u32) -> u32 {
    bounded_walk_left = size;
    return bounded_walk_next(cursor, size);
}

/// Continues the walk. Returns `cursor`, or END if it is not in memory or as many entries as memory has were visited.
fn bounded_walk_next(cursor: u32, size: u32) -> u32 {
    if cursor >= size || bounded_walk_left == 0u {
        return END;
    }
    bounded_walk_left -= 1u;
    return cursor;
}
