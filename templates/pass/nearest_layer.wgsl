// Draws the scene before the first iteration of peeling, to find the nearest layer of each pixel.

@fragment
fn nearest_layer(inputs: FragmentInput) {
    nearest_layer_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Passes one fragment to the search. `position` is the fragment's, in pixels.
fn nearest_layer_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_is_drawn(position, fragment) {
        peeling_find_first(pixel_index(position), fragment_pack(fragment).key);
    }
}
