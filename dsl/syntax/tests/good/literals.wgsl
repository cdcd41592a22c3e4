fn user_floats() -> f32 {
    let a = 1.0;
    let b = 0.001;
    let c = 1.0;
    let d = 2.5;
    let e = 3.4028234663852886e38;
    let g = 1.1754944e-38;
    let h = 1.1920929e-7;
    let i = 3.1415927f + 6.2831855f + 1.4142135f;
    let j = 1000.5;
    let k = 16777216.0;
    return a + b + c + d + e * g * h + i + j + k + 10000000000.0 + 0.1f * 3.0f;
}

fn user_wholes(id: u32, step_: i32) -> u32 {
    let a = 3i;
    let b = 3u;
    let c = 255u;
    let d = 10u;
    let e = 4000000000u;
    let g = 4294967295u;
    let h = -7i;
    let i = 5i;
    return select(b + d + e + g, id + c, i > step_ + h && a < i);
}

fn user_truth() -> bool {
    let yes = true;
    return yes != false;
}

fn user_admit_0(f: Fragment) -> bool {
    return f.id > 2u && uniforms.step_ < 3i && 1i << 3u > uniforms.step_ && (f.id & (1u << 31u)) == 0u;
}
