// Words in texels of two 16-bit channels: texels of whole words may not have several samples.

/// A word as two halves, the lower first.
fn word_halves(word: u32) -> vec2<u32> {
    return vec2<u32>(word & 0xffffu, word >> 16u);
}

fn word_of_halves(halves: vec2<u32>) -> u32 {
    return halves.x | (halves.y << 16u);
}
