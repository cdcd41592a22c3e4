// Drops fragments that the storage does not keep. Storages and locks pass every such fragment to this row, so every
// loss is counted.

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
}

fn on_culled(pixel: u32, lost: Packed) {
    count_event(CULLED);
}

fn overflow_is_empty(pixel: u32) -> bool {
    return true;
}

fn overflow_finish(pixel: u32, color: vec4<f32>) -> vec4<f32> {
    return color;
}
