// Row after row: pixels of one row are neighbours in memory. A slice of a picture begins at `first_row`.

fn pixel_index(position: vec2<f32>) -> u32 {
    let at = vec2<u32>(position);
    return (at.y - frame.first_row) * frame.width + at.x;
}

fn pixel_count() -> u32 {
    return frame.width * frame.height;
}
