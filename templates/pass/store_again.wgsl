// Stores the scene's fragments, round after round: each comes again in every round. Events are counted in the first.

@fragment
fn store(varyings: Varyings) {
    store_fragment(varyings.position.xy, varyings_fragment(varyings));
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
