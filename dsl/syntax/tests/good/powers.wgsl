fn user_numbers(x: f32, y: f32) -> f32 {
    let value = y - 1.0;
    return pow(x, 2.5) + pow(x, -1.0) + select(pow(x, 0.0), 1.0, 0.0 == 0.0) + select(pow(x, y), 1.0, y == 0.0) + select(pow(x + 1.0, value), 1.0, value == 0.0);
}

fn user_vectors(v: vec3<f32>, y: f32) -> vec3<f32> {
    let value = -0.0;
    return pow(v, vec3<f32>(0.5)) * select(pow(v, vec3<f32>(y)), vec3<f32>(1.0), y == 0.0) + select(pow(v, vec3<f32>(value)), vec3<f32>(1.0), value == 0.0);
}
