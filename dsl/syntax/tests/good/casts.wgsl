fn user_casts(x: f32, n: u32, i: i32, b: bool, f: Fragment) -> f32 {
    let a = select(u32(x), 4294967295u, x >= 4294967296.0);
    let value = x * 255.0;
    let c = select(i32(value), 2147483647i, value >= 2147483648.0);
    let d = f32(n);
    let e = i32(n) + i;
    let g = u32(i) + n;
    let h = u32(b);
    let j = i32(b);
    let k = n;
    let l = x;
    let m = select(u32(f.depth), 4294967295u, f.depth >= 4294967296.0);
    let value_1 = 3.7;
    let o = f32(3i) + f32(select(u32(value_1), 4294967295u, value_1 >= 4294967296.0));
    let p = u32(-1i);
    return f32(a + g + h + k + m + p) + f32(c + e + j) + d + l + o;
}
