// Fragments stay as the storage gives them. If there are more than fit, the farthest are left out.

fn sort_gather(entry: Packed) {
    layers_append(entry);
}

fn sort_finish() {}
