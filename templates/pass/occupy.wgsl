// Draws the scene ahead of the store pass, for a cull that wants to know where in their range each pixel's keys lie:
// the same fragments, the same constraints.

@fragment
fn occupy(varyings: Varyings) {
    occupy_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Marks where one fragment lies. `position` is the fragment's, in pixels.
fn occupy_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        cull_occupy(pixel_index(position), fragment_pack(fragment));
    }
}
