// Stores the scene's fragments. Those that have a place of their own are stored at once; only the others go on to where
// writers of one pixel take turns.

@fragment
fn store(varyings: Varyings) {
    store_fragment(varyings.position.xy, varyings_fragment(varyings));
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
    // A statement of its own, ahead of the lock: lanes of one wave that have a place must not wait for those that spin.
    let is_done = storage_reserve(pixel, entry);
    if !is_done {
        sync_store(pixel, entry);
    }
}
