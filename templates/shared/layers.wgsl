// The fragments of one pixel, gathered from the storage: what sorts work on and effects read.

var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;

fn layer_count() -> u32 {
    return gathered;
}

fn layer(index: u32) -> Fragment {
    return fragment_unpack(layers[min(index, LAYERS - 1u)]);
}
