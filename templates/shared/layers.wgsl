// The fragments of one pixel, read from the storage: sorts order them and effects read them. If a pixel has more than
// LAYERS, the farthest are dropped and counted, for any order of arrival.

var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;
/// The number of fragments that did not fit.
var<private> layers_dropped: u32;

fn sorted_count() -> u32 {
    return gathered;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper invocation may read a layer of a pixel without fragments.
    return fragment_unpack(layers[min(index, max(gathered, 1u) - 1u)]);
}

/// Forgets the fragments of the pixel.
fn layers_begin() {
    gathered = 0u;
    layers_dropped = 0u;
}

/// Appends one fragment. A sort that gathers by this function calls `layers_finish` before it sorts: what does not fit
/// is handled there, because a loop inside of the loop over the fragments would slow down every pixel.
fn layers_gather(entry: Packed) {
    if gathered < LAYERS {
        layers[gathered] = entry;
        gathered += 1u;
    } else {
        layers_dropped += 1u;
    }
}

/// Completes `layers_gather`: reads the pixel again if there were more than LAYERS fragments, and counts the others.
fn layers_finish() {
    if layers_dropped == 0u {
        return;
    }
    count_losses(LAYERS_EXCEEDED, layers_dropped);
    var position = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        if position >= LAYERS {
            layers_replace_farthest(resolve_read(cursor));
        }
        position += 1u;
    }
}

/// Appends one fragment, and handles at once what does not fit.
fn layers_append(entry: Packed) {
    if gathered < LAYERS {
        layers[gathered] = entry;
        gathered += 1u;
        return;
    }
    count_loss(LAYERS_EXCEEDED);
    layers_replace_farthest(entry);
}

fn layers_replace_farthest(entry: Packed) {
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

/// Inserts one fragment in order, nearest first.
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
