// The fragments of one pixel, gathered from the storage: what sorts work on and effects read.

var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;

fn layer_count() -> u32 {
    return gathered;
}

fn layer(index: u32) -> Fragment {
    return fragment_unpack(layers[min(index, LAYERS - 1u)]);
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
