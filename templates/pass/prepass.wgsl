// Draws the scene before the store pass, for a storage that needs data on all fragments first: the same fragments and
// constraints.

@fragment
fn prepass(inputs: FragmentInput) {
    prepass_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Passes one fragment to the storage. `position` is the fragment's, in pixels.
fn prepass_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_prepass(pixel_index(position), fragment_pack(fragment));
    }
}
