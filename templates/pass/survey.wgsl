// Draws the scene ahead of the store pass, for a storage that must know what will come: the same fragments, under the
// same constraints.

@fragment
fn survey(varyings: Varyings) {
    survey_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Surveys one fragment. `position` is the fragment's, in pixels.
fn survey_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_survey(pixel_index(position), fragment_pack(fragment));
    }
}
