// Writes the depth beyond which a depth test rejects a pixel's fragments. Keys are bits of depths. LIMIT_SLACK raises
// the limit by a few units in the last place, because a rasteriser may test a slightly different depth than shaders
// read.

const LIMIT_SLACK = 16u;

@fragment
fn limit(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return 1.0;
    }
    return min(bitcast<f32>(cull_last(pixel_index(position.xy)) + LIMIT_SLACK), 1.0);
}
