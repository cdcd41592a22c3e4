fn user_either(a: bool, b: bool) -> bool {
    return a || b;
}

fn user_compared(x: f32, y: f32) -> bool {
    return user_either((x < y), y > 1.0);
}

fn user_chosen(x: f32, y: f32) -> bool {
    return select((x < 1.0), y > 1.0, x < y);
}
