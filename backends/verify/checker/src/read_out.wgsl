// Reads what a pixel holds, one fragment at a time. A walk is one invocation, because storages may count along the way.

@compute @workgroup_size(1)
fn read_out() {
    let pixel = pixel_index(vec2<f32>(0.5));
    let cursor = walk_to(pixel, 0u);
    let entry = storage_read(pixel, cursor);
}

/// Returns the cursor after `number` fragments of the pixel, or END.
fn walk_to(pixel: u32, number: u32) -> u32 {
    var cursor = storage_first(pixel);
    for (var passed = 0u; passed < number && cursor != END; passed++) {
        cursor = storage_next(pixel, cursor);
    }
    return cursor;
}
