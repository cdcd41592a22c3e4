// Insertion sort, nearest first, while the fragments are read. If there are more than fit, the farthest fall off
// the end: what remains are the nearest, whatever the order of arrival.

fn sort_gather(entry: Packed) {
    layers_insert(entry);
}

fn sort_finish() {}
