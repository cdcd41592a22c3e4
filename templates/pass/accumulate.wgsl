// Goes on with the effect of each pixel: adds the fragments that this iteration has stored to what earlier ones have
// accumulated.

/// The index of the pixel.
var<private> resolved: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return;
    }
    resolved = pixel_index(position.xy);
    peeling_resume(resolved);
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        sort_gather(resolve_read(cursor));
    }
    sort_finish();
    if peeling_layer_count(sorted_count()) > 0u {
        samples_resolve();
    }
    peeling_advance();
}

fn resolve_first() -> u32 {
    return storage_first(resolved);
}

fn resolve_next(cursor: u32) -> u32 {
    return storage_next(resolved, cursor);
}

fn resolve_read(cursor: u32) -> Packed {
    return storage_read(resolved, cursor);
}
