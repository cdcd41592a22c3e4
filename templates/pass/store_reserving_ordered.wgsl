// Stores the scene's fragments: those that reserve a slot at once, the others inside an interlock. Targets require its
// begin and end at the top level of the entry point, reached on every path, so conditions replace the early returns of
// other skeletons. A fragment that waits for others' slots waits before the interlock begins.

@fragment
fn store(inputs: FragmentInput) {
    let fragment = fragment_from_inputs(inputs);
    let pixel = pixel_index(inputs.position.xy);
    let entry = fragment_pack(fragment);
    var accepted = fragment_enters_counted(inputs.position.xy, fragment);
    if accepted && cull_fragment(pixel, entry) {
        on_culled(pixel, entry);
        accepted = false;
    }
    if accepted {
        accepted = !storage_reserve(pixel, entry);
    }
    critical_begin();
    if accepted {
        storage_insert(pixel, entry);
    }
    critical_end();
}
