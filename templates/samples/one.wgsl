// One sample per pixel: effects read every kept fragment, in order.

fn samples_resolve() -> vec4<f32> {
    return resolve_layers();
}

fn samples_share(entry: Packed) -> f32 {
    return 1.0;
}

fn layer_count() -> u32 {
    return sorted_count();
}

fn layer(index: u32) -> Fragment {
    return sorted_layer(index);
}
