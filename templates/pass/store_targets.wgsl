// Stores the scene's fragments in render targets, one word each; fixed-function tests decide which of them are kept.

@fragment
fn store(inputs: FragmentInput) -> Targets {
    let fragment = fragment_from_inputs(inputs);
    if !fragment_enters_counted(inputs.position.xy, fragment) {
        discard;
    }
    return fragment_targets(fragment_pack(fragment));
}
