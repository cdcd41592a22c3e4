// Stores the scene's fragments, round after round: each comes again in every round. Events are counted in the first.

@fragment
fn store(varyings: Varyings) {
    store_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Stores one fragment. `position` is the fragment's, in pixels.
fn store_fragment(position: vec2<f32>, fragment: Fragment) {
    if !admit(fragment) {
        return;
    }
    let is_hidden = opaque_hides(position, fragment);
    if frame.iteration == 0u {
        count_event(select(GENERATED, OCCLUDED, is_hidden));
    }
    if is_hidden {
        return;
    }
    sync_store(pixel_index(position), fragment_pack(fragment));
}
