// For storages that keep their fragments sorted: an effect reads them from the storage one after the other, and no
// array holds a copy. The two fragments that were read last stay in variables, so that an effect may compare
// neighbours. An effect that reads farther backwards walks from the first fragment again.

/// The number of fragments of the pixel.
var<private> walk_count: u32;
/// The fragment at `walk_index`, and where it is stored.
var<private> walk_current: Packed;
var<private> walk_cursor: u32;
var<private> walk_index: u32;
/// The fragment before it.
var<private> walk_previous: Packed;

fn sort_begin() {
    walk_count = 0u;
}

fn sort_gather(entry: Packed) {
    walk_count += 1u;
}

fn sort_finish() {
    walk_restart();
}

fn sorted_count() -> u32 {
    return walk_count;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper invocation may read a layer of a pixel without fragments.
    let clamped = min(index, max(walk_count, 1u) - 1u);
    if clamped + 1u == walk_index {
        return fragment_unpack(walk_previous);
    }
    if clamped < walk_index {
        walk_restart();
    }
    while walk_index < clamped && walk_cursor != END {
        walk_previous = walk_current;
        walk_index += 1u;
        walk_read(resolve_next(walk_cursor));
    }
    return fragment_unpack(walk_current);
}

fn walk_restart() {
    walk_index = 0u;
    walk_read(resolve_first());
}

fn walk_read(cursor: u32) {
    walk_cursor = cursor;
    if cursor != END {
        walk_current = resolve_read(cursor);
    }
}
