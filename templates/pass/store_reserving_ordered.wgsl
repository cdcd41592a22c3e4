// Stores the scene's fragments: those that have a place of their own at once, the others inside an interlock. Targets
// want its ends at the top level of the entry point, with no way around them, so what elsewhere returns early is a
// condition here. Whoever waits for another's slot does so before the interlock begins.

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
    if wanted {
        wanted = !storage_reserve(pixel, entry);
    }
    critical_begin();
    if wanted {
        storage_insert(pixel, entry);
    }
    critical_end();
}
