fn user_sums(a: f32, b: f32, c: f32) -> f32 {
    return a - (b - c) + a * (b + c) / (a / b) % c - (-a) + a * b * c;
}

fn user_vectors(v: vec3<f32>, w: vec3<f32>, s: f32) -> vec3<f32> {
    return (v + w) * s + s * v / w - (-v % 2.0) + (v - 1.0) * (1.0 / w);
}

fn user_bits(a: u32, b: u32) -> u32 {
    return (a & 255u) | ((b << 3u) ^ (~a >> (uniforms.shift + 1u))) | (((a + b) << 2u) & 7u);
}

fn user_signed(a: i32, b: i32) -> i32 {
    return -a * -3i + (b >> 2u) - (a << u32(b)) + i32(-2147483648) + i32(-2147483648);
}

fn user_compared(a: f32, b: f32, c: bool) -> bool {
    return (a < b && b <= 2.0) || (!(a == b) == c && (a > b || c) && a + 1.0 >= b * 2.0);
}

fn user_truths(a: bool, b: bool) -> bool {
    return (a & b) | (!a != b);
}

fn user_compound(x: f32, n: u32, v: vec3<f32>) -> f32 {
    var y = x;
    y += 1.0;
    y -= x * 2.0;
    y *= y;
    y /= 3.0;
    y %= 2.0;
    var m = n;
    m &= 3u;
    m |= 4u;
    m ^= n;
    m <<= 2u;
    m >>= 1u;
    var w = v;
    w.x += y;
    w[1u] *= 2.0;
    w += v;
    w *= 0.5;
    var even = m % 2u == 0u;
    even = even != true;
    return select(w.y, w.z, even);
}
