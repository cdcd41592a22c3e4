fn user_ordered(x: f32) -> f32 {
    var y = x;
    let value = y;
    y = 2.0;
    let z = value + y * y;
    let value_1 = y;
    y += 1.0;
    let w = vec2<f32>(value_1, y);
    return z + w.x + w.y;
}
