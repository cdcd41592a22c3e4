// Narrows the range of each pixel's keys to those that may stay.

@compute @workgroup_size(8, 8)
fn narrow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x >= frame.width || invocation.y >= frame.height {
        return;
    }
    cull_narrow(pixel_index(vec2<f32>(invocation.xy + vec2<u32>(0u, frame.first_row))));
}
