// The edges of the frame, or of the slice of it that is drawn.

/// Returns whether a position, in pixels, is inside the frame or slice. Quads cross its edges, so helper invocations
/// run outside: their pixels are not in memory, or belong to other columns.
fn is_in_frame(position: vec2<f32>) -> bool {
    let at = vec2<u32>(position);
    // Rows above the slice wrap around to numbers beyond its height.
    return at.x < frame.width && at.y - frame.first_row < frame.height;
}
