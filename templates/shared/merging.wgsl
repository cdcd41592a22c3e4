// Two fragments as one.

/// `near` with the colour of both, the nearer over the farther (Porter & Duff 1984), as straight alpha. Its other words
/// stay.
fn merge_over(near: Packed, far: Packed) -> Packed {
    let front = fragment_unpack(near).color;
    let back = fragment_unpack(far).color;
    let shown = (1.0 - front.a) * back.a;
    let alpha = front.a + shown;
    // Of neither is anything seen, and there is nothing to divide by.
    if alpha == 0.0 {
        return near;
    }
    let color = (front.a * front.rgb + shown * back.rgb) / alpha;
    return packed_recolored(near, vec4<f32>(color, alpha));
}
