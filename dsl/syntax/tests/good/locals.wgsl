fn user_again(x: f32) -> f32 {
    let x_1 = x + 1.0;
    let x_2 = x_1 * x_1;
    let y: f32 = x_2;
    var var_ = y;
    var_ += 1.0;
    let layers_ = var_;
    let user_x_ = layers_;
    return user_x_;
}

fn user_inside(a: f32, c: bool) -> f32 {
    var sum = a;
    {
        let a_1 = a * 2.0;
        sum += a_1;
    }
    if c {
        let a_1 = 3.0;
        sum += a_1;
    }
    return sum;
}

fn user_mutable(x: f32, _n: u32, v: vec2<f32>) -> f32 {
    var x_1 = x;
    var _n_1 = _n;
    var v_1 = v;
    x_1 += 1.0;
    v_1.x = x_1;
    v_1.y *= 2.0;
    return v_1.x + v_1.y;
}

fn user_reserved(f: Fragment) -> f32 {
    let min_ = f.length_ + f.fract__ * uniforms.step_;
    let vec3f_ = min_ + uniforms.mix_.x + f32(f.type_);
    return vec3f_;
}

fn user_copies(f: Fragment) -> f32 {
    var g = f;
    g.depth = 1.0;
    g.color.x += g.depth;
    return g.color.x;
}
