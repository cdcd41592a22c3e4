// Batcher's merge exchange (1968; Knuth, The Art of Computer Programming 3, sec. 5.2.2, Algorithm M) for any number of
// fragments: sorts, then merges, sequences whose members lie ever closer together. It compares less often than the
// bitonic network, and as there the number of fragments alone decides which places are compared.

fn sort_gather(entry: Packed) {
    layers_append(entry);
}

fn sort_finish() {
    var span = 1u;
    while 2u * span < gathered {
        span *= 2u;
    }
    for (var block = span; block > 0u; block /= 2u) {
        // The first comparisons are inside of a block, the others between blocks ever closer to each other.
        odd_even_compare(block, 0u, block);
        for (var distance = span; distance > block; distance /= 2u) {
            odd_even_compare(block, block, distance - block);
        }
    }
}

/// Compares every place whose index has the bit `block` as in `bit` with the place `distance` behind it.
fn odd_even_compare(block: u32, bit: u32, distance: u32) {
    for (var index = 0u; index + distance < gathered; index++) {
        if (index & block) == bit && nearer(layers[index + distance], layers[index]) {
            let moved = layers[index];
            layers[index] = layers[index + distance];
            layers[index + distance] = moved;
        }
    }
}
