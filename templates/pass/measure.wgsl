// Draws the scene ahead of the store pass, for a cull that wants the range of each pixel's keys: the same fragments,
// the same constraints.

@fragment
fn measure(varyings: Varyings) {
    measure_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Takes one fragment into the range. `position` is the fragment's, in pixels.
fn measure_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        cull_measure(pixel_index(position), fragment_pack(fragment));
    }
}
