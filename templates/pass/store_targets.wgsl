// Stores the scene's fragments in targets, a word in each; tests that are fixed function decide which of them stay.

@fragment
fn store(varyings: Varyings) -> Targets {
    let fragment = varyings_fragment(varyings);
    if !admit(fragment) {
        discard;
    }
    if opaque_hides(varyings.position.xy, fragment) {
        count_event(OCCLUDED);
        discard;
    }
    count_event(GENERATED);
    return fragment_targets(fragment_pack(fragment));
}
