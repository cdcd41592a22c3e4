// Finishes the stream of each pixel: composites the remaining fragments behind those that have left, nearest first.
// The last fragment is its own neighbour. Pixels without fragments keep the content of the target.

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return vec4<f32>(0.0);
    }
    let pixel = pixel_index(position.xy);
    var cursor = storage_first(pixel);
    if cursor == END {
        if overflow_is_empty(pixel) {
            discard;
        }
        return overflow_finish(pixel, vec4<f32>(0.0));
    }
    var streamed = storage_streamed(pixel);
    var front = storage_read(pixel, cursor);
    while cursor != END {
        cursor = storage_next(pixel, cursor);
        var back = front;
        if cursor != END {
            back = storage_read(pixel, cursor);
        }
        streamed = stream_composite(streamed, front, back);
        front = back;
    }
    return overflow_finish(pixel, streamed);
}
