// Batcher's merge exchange (1968; Knuth, The Art of Computer Programming 3, sec. 5.2.2, Algorithm M) for any number of
// fragments: sorts, then merges, sequences whose elements have decreasing distances. It needs fewer comparisons than
// the bitonic network; as there, only the number of fragments decides which indices are compared.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
    var span = 1u;
    while 2u * span < gathered {
        span *= 2u;
    }
    for (var block = span; block > 0u; block /= 2u) {
        // The first comparisons are inside a block, the others between blocks at decreasing distances.
        odd_even_compare(block, 0u, block);
        for (var distance = span; distance > block; distance /= 2u) {
            odd_even_compare(block, block, distance - block);
        }
    }
}

/// Compares every index whose bit `block` equals that of `bit` with the index `distance` behind it.
fn odd_even_compare(block: u32, bit: u32, distance: u32) {
    for (var index = 0u; index + distance < gathered; index++) {
        if (index & block) == bit && nearer(layers[index + distance], layers[index]) {
            let moved = layers[index];
            layers[index] = layers[index + distance];
            layers[index + distance] = moved;
        }
    }
}
