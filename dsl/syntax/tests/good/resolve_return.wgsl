fn user_resolve() -> vec4<f32> {
    if layer_count() == 0u {
        return vec4<f32>(0.0);
    }
    let first = layer(0u);
    let last = layer(layer_count() - 1u);
    return select(last.color * 0.5, first.color, first.depth < 0.5);
}
