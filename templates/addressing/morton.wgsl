// Morton order (1966) in blocks of 8 x 8 pixels; blocks are in row-major order. Inside a block the bits of column and
// row alternate, so every aligned square of a power of two is contiguous. One curve over the whole frame would pad it
// to a square; blocks pad columns and rows to 8. A slice of an image begins at `first_row`, and its blocks with it.

const BLOCK_SIDE = 8u;

fn pixel_index(position: vec2<f32>) -> u32 {
    let at = vec2<u32>(position) - vec2<u32>(0u, frame.first_row);
    let block = at.y / BLOCK_SIDE * morton_blocks(frame.width) + at.x / BLOCK_SIDE;
    let inside = morton_spread(at % vec2<u32>(BLOCK_SIDE));
    return block * BLOCK_SIDE * BLOCK_SIDE + (inside.x | (inside.y << 1u));
}

/// Returns the texel of a pixel in textures of the size of the frame.
fn pixel_texel(pixel: u32) -> vec2<u32> {
    let block = pixel / (BLOCK_SIDE * BLOCK_SIDE);
    let corner = BLOCK_SIDE * vec2<u32>(block % morton_blocks(frame.width), block / morton_blocks(frame.width));
    let inside = morton_gather(vec2<u32>(pixel, pixel >> 1u));
    return corner + inside + vec2<u32>(0u, frame.first_row);
}

fn pixel_count() -> u32 {
    return morton_blocks(frame.width) * morton_blocks(frame.height) * BLOCK_SIDE * BLOCK_SIDE;
}

fn morton_blocks(length: u32) -> u32 {
    return (length + BLOCK_SIDE - 1u) / BLOCK_SIDE;
}

/// Returns the three bits of each number with a zero bit before each of them.
fn morton_spread(numbers: vec2<u32>) -> vec2<u32> {
    let twos = (numbers | (numbers << vec2<u32>(2u))) & vec2<u32>(0x13u);
    return (twos | (twos << vec2<u32>(1u))) & vec2<u32>(0x15u);
}

/// Removes the zero bits that `morton_spread` inserted.
fn morton_gather(numbers: vec2<u32>) -> vec2<u32> {
    let spread = numbers & vec2<u32>(0x15u);
    let twos = (spread | (spread >> vec2<u32>(1u))) & vec2<u32>(0x13u);
    return (twos | (twos >> vec2<u32>(2u))) & vec2<u32>(0x7u);
}
