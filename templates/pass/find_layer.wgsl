// Draws the scene in an iteration of peeling, to find the nearest layer that is left, and to write its depth: the depth
// test of the next draws then rejects the fragments of other layers.

@fragment
fn find_layer(inputs: FragmentInput) {
    let fragment = fragment_from_inputs(inputs);
    let pixel = pixel_index(inputs.position.xy);
    let entry = fragment_pack(fragment);
    if !fragment_is_drawn(inputs.position.xy, fragment) || !peeling_is_left(pixel, entry) {
        discard;
    }
    peeling_find(pixel, entry);
}
