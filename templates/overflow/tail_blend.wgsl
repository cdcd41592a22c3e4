// Fragments that are not kept are blended behind the kept ones (Maule et al. 2013; nvpro calls it tail blending): each
// lost fragment over the tail so far, as if it were in front of all fragments lost earlier. This is approximate:
// colours of the tail depend on the order of arrival, and frames may differ if that order is a race. The tail's
// transmittance is a product and does not depend on the order, except for the rounding of floats.
//
// The tail is read, modified and written, so only the critical section may access it: that is where a storage
// displaces fragments. Fragments lost elsewhere (a timeout at a lock, a full pool) are counted and not blended;
// nothing is culled.
//
// Memory: 4 words per pixel, a premultiplied colour of floats.

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
    if reason == DISPLACED {
        let color = fragment_unpack(lost).color;
        tail_blend_add(pixel, vec4<f32>(color.rgb, color.a * samples_share(lost)));
    }
}

fn on_culled(pixel: u32, lost: Packed) {
    count_event(CULLED);
}

fn overflow_is_empty(pixel: u32) -> bool {
    return blended_load(3u, pixel) == 0u;
}

/// Returns `color`, which is premultiplied, over the tail.
fn overflow_finish(pixel: u32, color: vec4<f32>) -> vec4<f32> {
    return color + (1.0 - color.a) * tail_blend_color(pixel);
}

/// Blends a colour of straight alpha over the tail.
fn tail_blend_add(pixel: u32, color: vec4<f32>) {
    let front = vec4<f32>(color.a * color.rgb, color.a);
    let words = bitcast<vec4<u32>>(front + (1.0 - color.a) * tail_blend_color(pixel));
    blended_store(0u, pixel, words.x);
    blended_store(1u, pixel, words.y);
    blended_store(2u, pixel, words.z);
    blended_store(3u, pixel, words.w);
}

fn tail_blend_color(pixel: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(vec4<u32>(
        blended_load(0u, pixel),
        blended_load(1u, pixel),
        blended_load(2u, pixel),
        blended_load(3u, pixel),
    ));
}
