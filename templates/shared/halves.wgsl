// Words in texels of two 16-bit channels, because texels of 32-bit words cannot be multisampled.

/// Returns a word as two halves, the lower first.
fn word_halves(word: u32) -> vec2<u32> {
    return vec2<u32>(word & 0xffffu, word >> 16u);
}

fn word_of_halves(halves: vec2<u32>) -> u32 {
    return halves.x | (halves.y << 16u);
}
