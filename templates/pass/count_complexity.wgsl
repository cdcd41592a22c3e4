// Draws the scene before any fragment is stored, to count the fragments of each pixel: the same fragments and
// constraints.

@fragment
fn count_complexity(inputs: FragmentInput) {
    count_complexity_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Counts one fragment. `position` is the fragment's, in pixels.
fn count_complexity_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        allocation_count(pixel_index(position));
    }
}
