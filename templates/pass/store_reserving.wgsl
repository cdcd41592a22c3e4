// Stores the scene's fragments. Fragments that reserve a slot are stored without the lock; only the others take the
// lock.

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
    // A separate statement before the lock: lanes with a slot must not wait for lanes of their wave that spin.
    let is_done = storage_reserve(pixel, entry);
    if !is_done {
        sync_store(pixel, entry);
    }
}
