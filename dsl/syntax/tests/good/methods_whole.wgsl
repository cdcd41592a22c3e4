fn user_unsigned(a: u32, b: u32) -> u32 {
    let c = min(a, b) + max(a, b) + clamp(a, 1u, b) + countOneBits(a) + countLeadingZeros(a) + countTrailingZeros(a);
    let d = reverseBits(a) + (a + b) + (a - b) * (a * b);
    let e = a - min(a, b) + (a + min(b, 4294967295u - a)) + (max(a, b) - min(a, b)) + a % b;
    let value = a + b;
    return c + d + e + (value - min(value, a * b));
}

fn user_signed(a: i32, b: i32) -> i32 {
    let c = abs(a) + min(a, b) + max(a, b) + clamp(a, -3i, b) + sign(a) + select(a % b, a % b + abs(b), a % b < 0i);
    let d = a + b + (a - b) + a * b + (-a);
    let e = u32(countOneBits(a)) + u32(countLeadingZeros(a)) + u32(countTrailingZeros(a)) + (u32(max(a, b)) - u32(min(a, b)));
    return c + d + i32(e);
}

fn user_resolve() -> vec4<f32> {
    let value = layer_count();
    let last = value - min(value, 1u);
    let value_1 = clamp(max(min(last, 3u), 1u), 0u, 2u);
    let first = max(value_1, last) - min(value_1, last);
    return layer(first).color;
}
