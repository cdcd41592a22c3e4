// Counts the pixels of each importance and each number of fragments. Pixels without fragments are not counted, and
// those with more than the capacity are counted as if they had that many: no pixel keeps more.

@compute @workgroup_size(16, 16)
fn count_by_importance(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x >= frame.width || invocation.y >= frame.height {
        return;
    }
    let pixel = pixel_index(vec2<f32>(invocation.xy + vec2<u32>(0u, frame.first_row)));
    let fragments = min(allocation_fragments(pixel), CAPACITY);
    if fragments > 0u {
        shares_atomic_add(allocation_level(pixel), fragments - 1u, 1u);
    }
}
