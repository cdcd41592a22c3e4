// A value of two neighbours that tells each of them, and what lies between, apart.

fn stream_value(front: Fragment, back: Fragment, gap: f32) -> vec4<f32> {
    return 0.5 * front.color + 0.25 * gap * back.color;
}
