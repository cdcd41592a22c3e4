fn user_criterion(f: Fragment) -> f32 {
    return select(1.0, f.depth, f.depth > 0.5);
}

fn user_resolve() -> vec4<f32> {
    if layer_count() > 2u {
        return layer(2u).color;
    } else {
        return vec4<f32>(0.0);
    }
}
