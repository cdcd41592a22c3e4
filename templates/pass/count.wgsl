// Counts the fragments of each pixel: the same scene and constraints as the store pass.

@fragment
fn count(inputs: FragmentInput) {
    count_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Counts one fragment. `position` is the fragment's, in pixels.
fn count_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_count(pixel_index(position));
    }
}
