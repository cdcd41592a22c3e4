// Merges two fragments.

/// Returns `near` with the colour of `near` over `far` (Porter & Duff 1984), as straight alpha. Its other words do not
/// change.
fn merge_over(near: Packed, far: Packed) -> Packed {
    let front = fragment_unpack(near).color;
    let back = fragment_unpack(far).color;
    let shown = (1.0 - front.a) * back.a;
    let alpha = front.a + shown;
    // Both are invisible, and the division below would be by zero.
    if alpha == 0.0 {
        return near;
    }
    let color = (front.a * front.rgb + shown * back.rgb) / alpha;
    return packed_recolored(near, vec4<f32>(color, alpha));
}
