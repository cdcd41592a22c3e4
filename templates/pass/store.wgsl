// Stores the scene's fragments.

@fragment
fn store(inputs: FragmentInput) {
    store_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Stores one fragment. `position` is the fragment's, in pixels.
fn store_fragment(position: vec2<f32>, fragment: Fragment) {
    if !fragment_enters_counted(position, fragment) {
        return;
    }
    let pixel = pixel_index(position);
    let entry = fragment_pack(fragment);
    if cull_fragment(pixel, entry) {
        on_culled(pixel, entry);
        return;
    }
    sync_store(pixel, entry);
}
