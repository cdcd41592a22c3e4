// Writes, for the depth test of boxes, a depth that all fragments of the pixel reach which no iteration has stored (D13
// sec. 3.3). A box whose every part is in front of it has no fragment left.
//
// Depths of boxes and of their objects are rounded differently, so what is written is nearer by some units in the last
// place.

const REACHED_DEPTH_MARGIN = 64u;

@fragment
fn reached_depth(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    if !is_in_frame(position.xy) {
        // A helper invocation: its result has no effect.
        return 1.0;
    }
    let key = peeling_reached(pixel_index(position.xy));
    if key == EMPTY {
        // Nothing is left.
        return 1.0;
    }
    return min(bitcast<f32>(max(key, REACHED_DEPTH_MARGIN) - REACHED_DEPTH_MARGIN), 1.0);
}
