// Narrows the range of each pixel's keys to those that can be kept.

@compute @workgroup_size(8, 8)
fn occupancy_bound(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x >= frame.width || invocation.y >= frame.height {
        return;
    }
    cull_occupancy_bound(pixel_index(vec2<f32>(invocation.xy + vec2<u32>(0u, frame.first_row))));
}
