fn user_small(x: f32, c: bool) -> f32 {
    let y = select(1.0 - x, x, c);
    return y + select(3.0, 2.0, x > 0.5);
}

fn user_returned(x: f32) -> f32 {
    if x > 1.0 {
        let y = x * 2.0;
        return y * y;
    } else if x < -1.0 {
        return 0.0;
    } else {
        return x;
    }
}

fn user_assigned(x: f32, n: u32) -> f32 {
    var y: f32;
    if n == 0u {
        y = user_small(x, true);
    } else if n == 1u {
        let z = x * 0.5;
        y = z * z;
    } else {
        y = 2.0;
    }
    var w = y;
    if n > 4u {
        w = user_small(y, false);
    } else {
        w = w * 2.0;
    }
    if w > 3.0 {
        w -= 1.0;
    } else if w < 1.0 {
        w += 1.0;
    }
    if w == 2.0 {
        return w;
    }
    if w == 4.0 {
    } else {
        w = 0.5;
    }
    return w;
}

fn user_nested(f: Fragment, c: bool) -> f32 {
    var g: Fragment;
    if c {
        g = f;
    } else {
        g = f;
    }
    let t = g.depth;
    let block = t * t;
    let t_1 = 2.0 * block;
    let d = f.depth;
    return max(block, t_1 + 1.0) + select(0.0, 1.0, d > 0.5);
}

fn user_early(x: f32) -> f32 {
    var y: f32;
    if x > 0.0 {
        y = x;
    } else {
        return 1.0;
    }
    if y > 2.0 {
        return 2.0;
    } else {
        return y * user_small(y, y > 1.0);
    }
}

fn user_lazy(x: f32, i: u32) -> bool {
    var holds = x > 0.0;
    if holds {
        let y = x * x;
        holds = y < 4.0;
    }
    var holds_1 = holds || i == 0u;
    if !holds_1 {
        let z = user_small(x, true);
        holds_1 = z > 1.0;
    }
    return holds_1;
}

fn user_chained(x: f32) -> f32 {
    if x > 1.0 {
        return 1.0;
    } else {
        let y = x * x;
        return select(x, 0.5, y > 0.5);
    }
}
