fn user_sizes(x: f32, y: f32) -> f32 {
    return abs(x) + min(x, y) + max(x, y) + clamp(x, 0.0, y) + select(1.0, -1.0, (bitcast<u32>(x) >> 31u) == 1u) + bitcast<f32>((bitcast<u32>(x) & 0x7fffffffu) | (bitcast<u32>(y) & 0x80000000u));
}

fn user_parts(x: f32, y: f32) -> f32 {
    let value = x * y;
    let value_1 = x + y;
    let value_2 = x - y;
    return floor(x) + ceil(x) + trunc(x) + round(x) + (x - trunc(x)) + (value - trunc(value)) + select(x % y, x % y + abs(y), x % y < 0.0) + select(value_1 % value_2, value_1 % value_2 + abs(value_2), value_1 % value_2 < 0.0);
}

fn user_powers(x: f32, y: f32) -> f32 {
    return sqrt(x) + 1.0 / x + 1.0 / (x + y) + select(pow(x, y), 1.0, y == 0.0) + exp(x) + exp2(x) + log(x) + log2(x) + fma(x, y, 1.0);
}

fn user_angles(x: f32, y: f32) -> f32 {
    return sin(x) + cos(x) + tan(x) + asin(x) + acos(x) + atan(x) + atan2(x, y) + radians(x) + degrees(x);
}

fn user_hyperbolic(x: f32) -> f32 {
    return sinh(x) + cosh(x) + tanh(clamp(x, -16.0, 16.0)) + asinh(x) + acosh(x) + atanh(x);
}

fn user_bits(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) + 1u);
}
