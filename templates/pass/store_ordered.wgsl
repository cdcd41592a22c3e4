// Stores the scene's fragments inside an interlock: between begin and end, fragments of one pixel run one at a time.
// Targets require begin and end at the top level of the entry point, reached on every path, so conditions replace the
// early returns of other skeletons. Helper invocations store nothing; the interlock does not wait for them.

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
    critical_begin();
    if accepted {
        storage_insert(pixel, entry);
    }
    critical_end();
}
