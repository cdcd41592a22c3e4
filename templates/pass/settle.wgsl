// Draws the scene again, for what a storage could not settle in one pass: the same fragments as in the store pass, each
// of which has been counted and culled there.

@fragment
fn settle(varyings: Varyings) {
    settle_fragment(varyings.position.xy, varyings_fragment(varyings));
}

/// Settles one fragment. `position` is the fragment's, in pixels.
fn settle_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        storage_settle(pixel_index(position), fragment_pack(fragment));
    }
}
