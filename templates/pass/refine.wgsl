// Draws the scene again, so that a storage can write further words of stored fragments: the same fragments as in the
// store pass, where each has been counted and culled.

@fragment
fn refine(inputs: FragmentInput) {
    refine_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Refines the stored words of one fragment. `position` is the fragment's, in pixels.
fn refine_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_refine(pixel_index(position), fragment_pack(fragment));
    }
}
