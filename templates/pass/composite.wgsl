// Writes the colour after the last iteration of peeling. Pixels without fragments keep the content of the target.

@fragment
fn composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return vec4<f32>(0.0);
    }
    let pixel = pixel_index(position.xy);
    return overflow_finish(pixel, resolve_result(pixel));
}
