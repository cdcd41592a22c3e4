// Draws the scene before the store pass, for a cull that needs the range of each pixel's keys: the same fragments and
// constraints.

@fragment
fn key_range(inputs: FragmentInput) {
    key_range_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Extends the range by the key of one fragment. `position` is the fragment's, in pixels.
fn key_range_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        cull_key_range(pixel_index(position), fragment_pack(fragment));
    }
}
