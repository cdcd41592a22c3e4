fn user_early(x: f32) -> f32 {
    if x > 1.0 {
        return 1.0;
    } else {
        return 2.0;
    }
}

fn user_stops(n: u32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < n; i++) {
        sum += 1.0;
        if i > 3u {
            break;
        }
        continue;
    }
    return sum;
}

fn user_unused(x: f32) -> f32 {
    return x;
}
