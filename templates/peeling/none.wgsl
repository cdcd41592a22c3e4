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

fn peeling_resume(pixel: u32) {}

fn peeling_layer_count(sorted: u32) -> u32 {
    return sorted;
}

fn peeling_is_copy(index: u32) -> bool {
    return false;
}

fn peeling_copy() -> Packed {
    return packed_of_key(EMPTY);
}

fn peeling_sorted_index(index: u32) -> u32 {
    return index;
}

fn peeling_color(transparent: vec3<f32>) -> vec3<f32> {
    return transparent;
}

fn peeling_transmittance() -> f32 {
    return 1.0;
}

fn peeling_suspend(color: vec3<f32>, transmittance: f32) {}
