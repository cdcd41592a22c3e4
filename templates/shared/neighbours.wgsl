// Pixels around the one that a resolve pass computes, for effects that read images of the description.

/// Returns the pixel `dx` to the right of another and `dy` below it; beyond the border of the frame, the nearest pixel.
fn neighbouring_pixel(pixel: u32, dx: i32, dy: i32) -> u32 {
    let last = vec2<i32>(vec2<u32>(frame.width, frame.height)) - 1;
    let offset = clamp(vec2<i32>(dx, dy), -last, last);
    let place = clamp(vec2<i32>(pixel_texel(pixel)) + offset, vec2<i32>(0), last);
    return pixel_index(vec2<f32>(place) + 0.5);
}
