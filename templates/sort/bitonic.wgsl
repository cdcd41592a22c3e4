// Batcher's bitonic network (1968) for any number of fragments. Every comparison moves the nearer fragment to the
// lower index, so indices from the number of fragments up to the next power of two behave like fragments behind all
// others: they never move, and comparisons with them are omitted. Which indices are compared depends only on the
// number.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
    for (var block = 2u; block < 2u * gathered; block *= 2u) {
        // With one of them mirrored, two sorted runs are one bitonic run; halving distances merge it.
        bitonic_compare(block - 1u);
        for (var distance = block / 4u; distance > 0u; distance /= 2u) {
            bitonic_compare(distance);
        }
    }
}

/// Compares every index with the index that differs in the bits of `mask`.
fn bitonic_compare(mask: u32) {
    for (var index = 0u; index < gathered; index++) {
        let partner = index ^ mask;
        if partner > index && partner < gathered && nearer(layers[partner], layers[index]) {
            let moved = layers[index];
            layers[index] = layers[partner];
            layers[partner] = moved;
        }
    }
}
