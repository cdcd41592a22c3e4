// Makes one colour of each pixel's fragments. Pixels without any keep what the target held.

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    var cursor = storage_first(pixel);
    while cursor != END {
        sort_gather(storage_read(pixel, cursor));
        cursor = storage_next(pixel, cursor);
    }
    sort_finish();
    if layer_count() == 0u {
        if overflow_is_empty(pixel) {
            discard;
        }
        return overflow_finish(pixel, vec4<f32>(0.0));
    }
    return overflow_finish(pixel, resolve_layers());
}
