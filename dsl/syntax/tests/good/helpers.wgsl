fn user_outer(f: Fragment) -> f32 {
    return user_inner(f) * uniforms.gain;
}

fn user_inner(f: Fragment) -> f32 {
    return f.depth - uniforms.cut + user_plain(2.0, 3u);
}

fn user_plain(x: f32, n: u32) -> f32 {
    return x * f32(n);
}

fn user_criterion(f: Fragment) -> f32 {
    return user_outer(f) + f.color.x;
}

fn user_admit_0(f: Fragment) -> bool {
    return user_outer(f) > 0.0;
}

fn user_admit_1(f: Fragment) -> bool {
    return uniforms.gain > 0.0;
}

fn user_admit_2(f: Fragment) -> bool {
    return f.id > 3u;
}
