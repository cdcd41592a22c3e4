// Row-major order: pixels of one row are neighbours in memory. A slice of an image begins at `first_row`.

fn pixel_index(position: vec2<f32>) -> u32 {
    let at = vec2<u32>(position);
    return (at.y - frame.first_row) * frame.width + at.x;
}

/// Returns the texel of a pixel in textures of the size of the frame.
fn pixel_texel(pixel: u32) -> vec2<u32> {
    return vec2<u32>(pixel % frame.width, pixel / frame.width + frame.first_row);
}

fn pixel_count() -> u32 {
    return frame.width * frame.height;
}
