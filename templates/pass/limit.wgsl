// Writes the depth beyond which a pixel's fragments are turned away, for a depth test to do it. Keys are bits of
// depths. A few last bits are added: whether a rasteriser tests the very depth that it shows a shader is its affair.

const LIMIT_SLACK = 16u;

@fragment
fn limit(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    return min(bitcast<f32>(cull_last(pixel_index(position.xy)) + LIMIT_SLACK), 1.0);
}
