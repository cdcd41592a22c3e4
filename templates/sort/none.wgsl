// Keeps the fragments in the order of the storage. If there are more than LAYERS, the farthest are dropped.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
}
