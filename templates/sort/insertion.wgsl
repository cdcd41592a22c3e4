// Insertion sort, nearest first, while the fragments are read. If there are more than fit, the farthest fall off
// the end: what remains are the nearest, whatever the order of arrival.

fn sort_gather(entry: Packed) {
    if gathered == LAYERS {
        count_loss(LAYERS_EXCEEDED);
        if !nearer(entry, layers[LAYERS - 1u]) {
            return;
        }
    } else {
        gathered += 1u;
    }
    var place = gathered - 1u;
    while place > 0u && nearer(entry, layers[place - 1u]) {
        layers[place] = layers[place - 1u];
        place -= 1u;
    }
    layers[place] = entry;
}

fn sort_finish() {}
