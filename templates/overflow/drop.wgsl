// A fragment that finds no place is dropped. Storages and locks hand every such fragment here, so that none is lost
// uncounted.

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
