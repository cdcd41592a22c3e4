// Counts the fragments of each pixel: the same scene, the same constraints as the store pass.

@fragment
fn count(varyings: Varyings) {
    count_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Counts one fragment. `position` is the fragment's, in pixels.
fn count_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_count(pixel_index(position));
    }
}
