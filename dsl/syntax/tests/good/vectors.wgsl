fn user_built(x: f32) -> vec4<f32> {
    let a = vec2<f32>(x, 1.0);
    let b = vec3<f32>(x, 2.0, 3.0);
    let c = vec4<f32>(x, 2.0, 3.0, 4.0);
    let d = vec3<f32>(x) + vec3<f32>(0.0) + vec3<f32>(1.0, 0.0, 0.0);
    let e = vec2<f32>(1.0) + vec2<f32>(0.0, 1.0) + a.xx;
    let g = c.xyz + c.wzy + b.zyx + d;
    let h = vec3<f32>(a + e, x) + g;
    let i = vec4<f32>(vec3<f32>(h.xy, 1.0), 2.0) + vec4<f32>(c.xyz, 0.5);
    return i + vec4<f32>(a[0u], b[1u], c[3u], c.w) + vec4<f32>(0.0, 0.0, 0.0, -1.0) * a.y;
}

fn user_element(v: vec4<f32>, n: u32) -> f32 {
    var w = v;
    w[n] = 1.0;
    w.y = w[0u];
    return w[n % 4u];
}
