// No image instead of a wrong one: if a fragment does not fit or times out at a lock, every pixel of the frame is
// magenta. Displaced fragments are no failure: a limit on the fragments kept implies them. Memory: 1 word.

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
    if reason != DISPLACED {
        failed_store(1u);
    }
}

fn on_culled(pixel: u32, lost: Packed) {
    count_event(CULLED);
}

fn overflow_is_empty(pixel: u32) -> bool {
    return failed_load() == 0u;
}

fn overflow_finish(pixel: u32, color: vec4<f32>) -> vec4<f32> {
    if failed_load() == 0u {
        return color;
    }
    return vec4<f32>(1.0, 0.0, 1.0, 1.0);
}
