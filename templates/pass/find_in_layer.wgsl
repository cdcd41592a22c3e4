// Draws the scene in an iteration of peeling before the store pass, to find which fragments of a layer it stores.

@fragment
fn find_in_layer(inputs: FragmentInput) {
    find_in_layer_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Passes one fragment to the search. `position` is the fragment's, in pixels.
fn find_in_layer_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_is_drawn(position, fragment) {
        peeling_find(pixel_index(position), fragment_pack(fragment));
    }
}
