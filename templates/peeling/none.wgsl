// The scene's fragments are stored once.

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    return false;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    return true;
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return true;
}

fn peeling_color(transparent: vec3<f32>) -> vec3<f32> {
    return transparent;
}

fn peeling_transmittance() -> f32 {
    return 1.0;
}

fn peeling_layer(index: u32) -> u32 {
    return index;
}

fn peeling_suspend(color: vec3<f32>, transmittance: f32) {}
