// Values of neighbours along the ray, composited front to back (B06 sec. 4.3): each fragment and the next make one
// value, that of the space between them, as a premultiplied colour. The last fragment is its own neighbour.

fn resolve_layers() -> vec4<f32> {
    var composited = vec4<f32>(0.0);
    let last = layer_count() - 1u;
    var front = layer(0u);
    for (var index = 0u; index <= last; index++) {
        let back = layer(min(index + 1u, last));
        composited += (1.0 - composited.a) * stream_value(front, back, back.depth - front.depth);
        front = back;
    }
    return composited;
}
