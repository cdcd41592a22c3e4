// Computes an image of the description: one value from each pixel's fragments, which later passes can read at other
// pixels. Pixels without fragments have the value 0.

/// The index of the pixel.
var<private> resolved: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) {
    if !is_in_frame(position.xy) {
        // A helper invocation: it has no pixel.
        return;
    }
    resolved = pixel_index(position.xy);
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        sort_gather(resolve_read(cursor));
    }
    sort_finish();
    if sorted_count() == 0u {
        image_store(resolved, vec4<f32>(0.0));
        return;
    }
    image_store(resolved, samples_resolve());
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
