fn user_either(a: bool, b: bool) -> bool {
    return a || b;
}

fn user_compared(x: f32, y: f32) -> bool {
    return user_either((x < y), y > 1.0);
}

fn user_chosen(x: f32, y: f32) -> bool {
    return select((x < 1.0), y > 1.0, x < y);
}

fn user_shifted(a: u32, b: u32) -> bool {
    return a < (b >> 2u) && a + 1u < (b >> a) && a <= b >> 2u && a < b << 2u && a >> 2u < b && a >> 2u > b >> 1u;
}

fn user_nested(a: u32, b: u32, c: bool) -> bool {
    return user_either(((a < b) == (a > b)), (a < (b >> 1u)) != (a >= b));
}

fn user_each(n: u32, m: u32) -> u32 {
    var sum = 0u;
    let i_end = n >> 2u;
    for (var i = 0u; i < i_end; i++) {
        if i < (n >> 3u) || user_either((i < (m >> 1u)), m >= 2u) {
            sum += select(m >> i, n >> 2u, i < m);
        }
    }
    return sum;
}

fn user_mixed(a: u32, b: u32, c: bool) -> bool {
    let bits = ((a * b) ^ ((a + b) & (a << 2u))) | (a / b);
    return (bits < (((a * b) >> 1u) | b) && c) || (c && bits > (a ^ b));
}
