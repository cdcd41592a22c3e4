// Fragments stay as the storage gives them. If there are more than fit, the farthest are left out.

fn sort_gather(entry: Packed) {
    if gathered < LAYERS {
        layers[gathered] = entry;
        gathered += 1u;
        return;
    }
    count_loss(LAYERS_EXCEEDED);
    var farthest = 0u;
    for (var index = 1u; index < LAYERS; index++) {
        if nearer(layers[farthest], layers[index]) {
            farthest = index;
        }
    }
    if nearer(entry, layers[farthest]) {
        layers[farthest] = entry;
    }
}

fn sort_finish() {}
