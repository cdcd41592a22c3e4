// Draws the scene before the store pass, to write the depth of each pixel's nearest fragment and nothing else.

@fragment
fn depth_prepass(inputs: FragmentInput) {
    if !fragment_enters(inputs.position.xy, fragment_from_inputs(inputs)) {
        discard;
    }
}
