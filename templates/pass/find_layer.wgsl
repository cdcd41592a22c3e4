// Draws the scene in an iteration of peeling, to find the nearest layer that is left, and to write its depth: the depth
// test of the next draws then rejects the fragments of other layers. So the first of these draws counts all fragments,
// and not the store pass.

@fragment
fn find_layer(inputs: FragmentInput) {
    let fragment = fragment_from_inputs(inputs);
    let position = inputs.position.xy;
    let pixel = pixel_index(position);
    let entry = fragment_pack(fragment);
    if !find_layer_counted(position, fragment) || !peeling_is_left(pixel, entry) {
        discard;
    }
    peeling_find(pixel, entry);
}

/// Returns whether the pass draws the fragment, and counts it in the first iteration.
fn find_layer_counted(position: vec2<f32>, fragment: Fragment) -> bool {
    if !is_in_frame(position) || !admit(fragment) {
        return false;
    }
    let is_hidden = opaque_hides(position, fragment);
    if frame.iteration == 0u {
        count_event(select(GENERATED, OCCLUDED, is_hidden));
    }
    return !is_hidden;
}
