// Insertion sort, nearest first, while the fragments are read. If there are more than LAYERS, the farthest are
// dropped, so the nearest remain, for any order of arrival.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_insert(entry);
}

fn sort_finish() {}
