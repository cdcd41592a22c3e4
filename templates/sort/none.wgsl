// Keeps the fragments in the order of the storage. If there are more than LAYERS, the farthest are dropped.

fn sort_gather(entry: Packed) {
    layers_append(entry);
}

fn sort_finish() {}
