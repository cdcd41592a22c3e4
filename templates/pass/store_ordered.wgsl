// Stores the scene's fragments inside an interlock: between begin and end, fragments of one pixel run one after the
// other. Targets want both at the top level of the entry point, with no way around them, so what elsewhere returns
// early is a condition here. Helper invocations store nothing; the interlock does not wait for them.

@fragment
fn store(varyings: Varyings) {
    let fragment = varyings_fragment(varyings);
    let pixel = pixel_index(varyings.position.xy);
    let entry = fragment_pack(fragment);
    var wanted = fragment_enters_counted(varyings.position.xy, fragment);
    if wanted && cull_fragment(pixel, entry) {
        on_culled(pixel, entry);
        wanted = false;
    }
    critical_begin();
    if wanted {
        storage_insert(pixel, entry);
    }
    critical_end();
}
