// Stores the scene's fragments in every iteration of a loop. Events are counted in the first iteration only.

@fragment
fn store(inputs: FragmentInput) {
    store_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Stores one fragment. `position` is the fragment's, in pixels.
fn store_fragment(position: vec2<f32>, fragment: Fragment) {
    if frame.iteration == 0u {
        if !fragment_enters_counted(position, fragment) {
            return;
        }
    } else if !fragment_enters(position, fragment) {
        return;
    }
    sync_store(pixel_index(position), fragment_pack(fragment));
}
