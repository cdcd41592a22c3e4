// One sample per pixel: effects read every kept fragment, in order.

fn samples_resolve() -> vec4<f32> {
    return resolve_layers();
}

fn samples_share(entry: Packed) -> f32 {
    return 1.0;
}

fn layer_count() -> u32 {
    return peeling_layer_count(sorted_count());
}

fn layer(index: u32) -> Fragment {
    if peeling_is_copy(index) {
        return fragment_unpack(peeling_copy());
    }
    return sorted_layer(peeling_sorted_index(index));
}
