// The fragments of one pixel, read from the storage: sorts order them and effects read them.

var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;

fn sorted_count() -> u32 {
    return gathered;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper invocation may read a layer of a pixel without fragments.
    return fragment_unpack(layers[min(index, max(gathered, 1u) - 1u)]);
}

/// Appends one fragment. If more than LAYERS arrive, the farthest are dropped, for any order of arrival.
fn layers_append(entry: Packed) {
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

/// Inserts one fragment in order, nearest first. If more than LAYERS arrive, the farthest are dropped.
fn layers_insert(entry: Packed) {
    if gathered == LAYERS {
        count_loss(LAYERS_EXCEEDED);
        if !nearer(entry, layers[LAYERS - 1u]) {
            return;
        }
    } else {
        gathered += 1u;
    }
    var slot = gathered - 1u;
    while slot > 0u && nearer(entry, layers[slot - 1u]) {
        layers[slot] = layers[slot - 1u];
        slot -= 1u;
    }
    layers[slot] = entry;
}
