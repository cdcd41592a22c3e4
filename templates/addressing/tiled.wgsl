// Tiles of 2 x 8 pixels in row-major order: two neighbours along a row and eight along a column are within 16 words. A
// slice of an image begins at `first_row`, and its tiles with it. Columns are padded to 2, rows to 8.

const TILE_WIDTH = 2u;
const TILE_HEIGHT = 8u;

fn pixel_index(position: vec2<f32>) -> u32 {
    let at = vec2<u32>(position) - vec2<u32>(0u, frame.first_row);
    let tile = at.y / TILE_HEIGHT * tiled_columns() + at.x / TILE_WIDTH;
    return (tile * TILE_HEIGHT + at.y % TILE_HEIGHT) * TILE_WIDTH + at.x % TILE_WIDTH;
}

/// Returns the texel of a pixel in textures of the size of the frame.
fn pixel_texel(pixel: u32) -> vec2<u32> {
    let tile = pixel / (TILE_WIDTH * TILE_HEIGHT);
    let corner = vec2<u32>(tile % tiled_columns() * TILE_WIDTH, tile / tiled_columns() * TILE_HEIGHT);
    let inside = vec2<u32>(pixel % TILE_WIDTH, pixel / TILE_WIDTH % TILE_HEIGHT);
    return corner + inside + vec2<u32>(0u, frame.first_row);
}

fn pixel_count() -> u32 {
    let rows = (frame.height + TILE_HEIGHT - 1u) / TILE_HEIGHT;
    return tiled_columns() * rows * TILE_WIDTH * TILE_HEIGHT;
}

fn tiled_columns() -> u32 {
    return (frame.width + TILE_WIDTH - 1u) / TILE_WIDTH;
}
