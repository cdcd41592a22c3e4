// Encodes numbers as words whose unsigned order is the order of the numbers, and unit vectors as one word.

/// Returns a depth as a word. Bits of floats from +0.0 up are in the order of their values; below zero and -0.0 become
/// 0.0.
fn depth_bits(depth: f32) -> u32 {
    return bitcast<u32>(max(depth, 0.0)) & 0x7fffffffu;
}

/// Returns any number as a word: all bits of negative numbers are inverted, and the sign of others. No NaN becomes
/// EMPTY.
fn ordered_bits(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return min(bits ^ select(0x80000000u, 0xffffffffu, (bits & 0x80000000u) != 0u), EMPTY - 1u);
}

/// Returns a unit vector as two 16-bit octahedral coordinates (Cigolle et al. 2014). The zero vector becomes +z.
fn octahedral_pack(direction: vec3<f32>) -> u32 {
    let size = abs(direction.x) + abs(direction.y) + abs(direction.z);
    let n = select(vec3<f32>(0.0, 0.0, 1.0), direction / size, size > 0.0);
    let folded = (1.0 - abs(n.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), n.xy >= vec2<f32>(0.0));
    return pack2x16snorm(select(folded, n.xy, n.z >= 0.0));
}

fn octahedral_unpack(word: u32) -> vec3<f32> {
    let e = unpack2x16snorm(word);
    let z = 1.0 - abs(e.x) - abs(e.y);
    let folded = (1.0 - abs(e.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), e >= vec2<f32>(0.0));
    return normalize(vec3<f32>(select(folded, e, z >= 0.0), z));
}
