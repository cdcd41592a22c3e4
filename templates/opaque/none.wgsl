// No opaque surface hides a fragment here: there is none, or a depth test has rejected the fragment before the shader.

fn opaque_hides(position: vec2<f32>, fragment: Fragment) -> bool {
    return false;
}
