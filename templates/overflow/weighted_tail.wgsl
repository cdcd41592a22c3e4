// Fragments that are not kept are summed up behind the kept ones (Maule et al. 2013, hybrid transparency: an exact
// core and a tail whose colour is the alpha-weighted mean and whose transmittance is the product). Integer sums do not
// depend on the order of arrival: the tail is the same for every order, and only atomic additions access it. Memory: 5
// words per pixel. Alpha is in steps of 1/4096, transmittance in steps of 2^(-1/2048) down to 2^-24; the word of a
// pixel can hold at most 87,381 opaque fragments.

const TAIL_ALPHA = 3u;
const TAIL_OPACITY = 4u;
const TAIL_STEPS = 4096.0;
const TAIL_OPACITY_STEPS = 2048.0;

fn on_lost(pixel: u32, lost: Packed, reason: u32) {
    count_loss(reason);
    weighted_tail_add(pixel, lost);
}

fn on_culled(pixel: u32, lost: Packed) {
    count_event(CULLED);
    weighted_tail_add(pixel, lost);
}

fn weighted_tail_add(pixel: u32, lost: Packed) {
    var color = clamp(fragment_unpack(lost).color, vec4<f32>(0.0), vec4<f32>(1.0));
    color.a *= samples_share(lost);
    let weighted = vec4<u32>(round(TAIL_STEPS * vec4<f32>(color.rgb * color.a, color.a)));
    let opacity = min(-log2(1.0 - color.a), 24.0);
    tail_atomic_add(0u, pixel, weighted.x);
    tail_atomic_add(1u, pixel, weighted.y);
    tail_atomic_add(2u, pixel, weighted.z);
    tail_atomic_add(TAIL_ALPHA, pixel, weighted.w);
    tail_atomic_add(TAIL_OPACITY, pixel, u32(round(TAIL_OPACITY_STEPS * opacity)));
}

fn overflow_is_empty(pixel: u32) -> bool {
    return tail_load(TAIL_ALPHA, pixel) == 0u;
}

/// Returns `color`, which is premultiplied, over the tail.
fn overflow_finish(pixel: u32, color: vec4<f32>) -> vec4<f32> {
    if overflow_is_empty(pixel) {
        return color;
    }
    let sum = vec3<f32>(f32(tail_load(0u, pixel)), f32(tail_load(1u, pixel)), f32(tail_load(2u, pixel)));
    let opacity = 1.0 - exp2(-f32(tail_load(TAIL_OPACITY, pixel)) / TAIL_OPACITY_STEPS);
    let mean = sum / f32(tail_load(TAIL_ALPHA, pixel));
    return color + (1.0 - color.a) * opacity * vec4<f32>(mean, 1.0);
}
