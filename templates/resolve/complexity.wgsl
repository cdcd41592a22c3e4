// Depth complexity as a heat map: the number of fragments that a pixel shows, from blue for few over green to red for
// COMPLEXITY_MOST and more. It shows where a frame is deep, and where a limit drops fragments.

fn resolve_layers() -> vec4<f32> {
    let share = min(f32(layer_count()) / f32(COMPLEXITY_MOST), 1.0);
    return vec4<f32>(
        clamp(2.0 * share - 1.0, 0.0, 1.0),
        1.0 - abs(2.0 * share - 1.0),
        clamp(1.0 - 2.0 * share, 0.0, 1.0),
        1.0,
    );
}
