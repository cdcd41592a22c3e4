// Fragments that are handed on one after the other, nearest first.

/// `streamed`, a premultiplied colour, with what lies from `front` to `back` behind it.
fn stream_composite(streamed: vec4<f32>, front: Packed, back: Packed) -> vec4<f32> {
    let near = fragment_unpack(front);
    let far = fragment_unpack(back);
    return streamed + (1.0 - streamed.a) * stream_value(near, far, far.depth - near.depth);
}
