// A value that depends on both neighbours and on the distance between them.

fn stream_value(front: Fragment, back: Fragment, gap: f32) -> vec4<f32> {
    return 0.5 * front.color + 0.25 * gap * back.color;
}
