// One triangle over the whole frame.

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(vec2<u32>(index & 1u, index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.0, 1.0);
}
