// Stores the scene's fragments in targets, a word in each; tests that are fixed function decide which of them stay.

@fragment
fn store(varyings: Varyings) -> Targets {
    let fragment = varyings_fragment(varyings);
    if !fragment_enters_counted(varyings.position.xy, fragment) {
        discard;
    }
    return fragment_targets(fragment_pack(fragment));
}
