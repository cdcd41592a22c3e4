// Goes on with the effect of each pixel, as `accumulate`, for the fragments that the pass reads: those of one side.

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
    return accumulate_side_seek(storage_first(resolved));
}

fn resolve_next(cursor: u32) -> u32 {
    return accumulate_side_seek(storage_next(resolved, cursor));
}

fn resolve_read(cursor: u32) -> Packed {
    return storage_read(resolved, cursor);
}

/// Returns the first cursor from `start` on whose fragment the pass reads.
fn accumulate_side_seek(start: u32) -> u32 {
    var cursor = start;
    while cursor != END {
        if peeling_reads(resolved, storage_read(resolved, cursor)) {
            return cursor;
        }
        cursor = storage_next(resolved, cursor);
    }
    return END;
}
