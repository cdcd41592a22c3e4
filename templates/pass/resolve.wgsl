// Computes one colour from each pixel's fragments. Pixels without fragments keep the content of the target.

/// The index of the pixel.
var<private> resolved: u32;

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return vec4<f32>(0.0);
    }
    resolved = pixel_index(position.xy);
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        sort_gather(resolve_read(cursor));
    }
    sort_finish();
    if sorted_count() == 0u {
        // If a pass serves only some pixels, the others have fragments but no layers.
        if overflow_is_empty(resolved) || resolve_first() != END {
            discard;
        }
        return overflow_finish(resolved, vec4<f32>(0.0));
    }
    return overflow_finish(resolved, samples_resolve());
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
