// Resets every pixel's storage to its empty state.

@compute @workgroup_size(8, 8)
fn reset(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x >= frame.width || invocation.y >= frame.height {
        return;
    }
    storage_reset(pixel_index(vec2<f32>(invocation.xy + vec2<u32>(0u, frame.first_row))));
}
