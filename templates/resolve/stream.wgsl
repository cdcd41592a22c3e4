// Front-to-back *over* (Porter & Duff 1984), one fragment at a time as a storage passes them on (B06 sec. 4.3). The
// value of two neighbours is the surface of the nearer: the space between them is empty.

fn stream_value(front: Fragment, back: Fragment, gap: f32) -> vec4<f32> {
    return vec4<f32>(front.color.a * front.color.rgb, front.color.a);
}
