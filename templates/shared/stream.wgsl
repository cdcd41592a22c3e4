// Composites fragments that a storage passes on one at a time, nearest first.

/// Returns `streamed`, a premultiplied colour, over the value of the neighbours `front` and `back`.
fn stream_composite(streamed: vec4<f32>, front: Packed, back: Packed) -> vec4<f32> {
    let near = fragment_unpack(front);
    let far = fragment_unpack(back);
    return streamed + (1.0 - streamed.a) * stream_value(near, far, far.depth - near.depth);
}
