// The fragments of one pixel, gathered from the storage: what sorts work on and effects read.

var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;

fn sorted_count() -> u32 {
    return gathered;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper lane, whose pixel has no fragment, may ask for one all the same.
    return fragment_unpack(layers[min(index, max(gathered, 1u) - 1u)]);
}

/// Appends one fragment. If there are more than fit, the farthest are left out, whatever the order of arrival.
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

/// Puts one fragment into its place, nearest first. If there are more than fit, the farthest fall off the end.
fn layers_insert(entry: Packed) {
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
