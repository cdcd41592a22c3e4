fn user_shifted(x: u32) -> u32 {
    var x_1 = x;
    let value = x_1;
    x_1 = 3u;
    let value_1 = value << 1u;
    x_1 *= 2u;
    return value_1 + x_1;
}

fn user_stored(v: vec3<f32>, y: f32) -> vec3<f32> {
    var y_1 = y;
    var w = v;
    let value = y_1;
    y_1 += 1.0;
    w[2u] = value;
    let value_1 = y_1;
    y_1 = 5.0;
    w[1u] += value_1;
    return w * y_1;
}

fn user_constant(a: u32) -> f32 {
    var c = a;
    c += 1u;
    let b = 2.5f * vec2<f32>(0.1, 3.75)[1u];
    if a == 0u {
        return 1.0;
    }
    return b + f32(2u);
}

fn user_signs(i: i32) -> i32 {
    return -(-i);
}
