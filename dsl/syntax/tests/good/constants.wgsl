fn user_third(x: f32) -> f32 {
    return x * (1.0f / 3.0f) + 0.1f * 3.0f;
}

fn user_sign_bit() -> i32 {
    return i32(-2147483648);
}

fn user_called() -> f32 {
    let value = 2.0;
    let value_1 = 1.0;
    return sqrt(value) + max(value_1, 2.0);
}

fn user_vector() -> vec3<f32> {
    return vec3<f32>(1.0) * 0.5f + vec3<f32>(0.0, -1.0, 0.0);
}
