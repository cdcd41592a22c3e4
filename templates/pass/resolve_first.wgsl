// Makes one colour of the first k fragments of each pixel, which its storage gives in order, the best first. Those
// behind them were displaced after they had been stored, and are handed to on_lost here. Pixels without any keep what
// the target held.

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    var number = 0u;
    var cursor = storage_first(pixel);
    while cursor != END {
        let entry = storage_read(pixel, cursor);
        if number < frame.k {
            sort_gather(entry);
        } else {
            on_lost(entry, DISPLACED);
        }
        number++;
        cursor = storage_next(pixel, cursor);
    }
    sort_finish();
    if layer_count() == 0u {
        discard;
    }
    return resolve_layers();
}
