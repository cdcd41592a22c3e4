fn user_scalars(a: vec2<f32>, b: vec3<f32>, c: vec4<f32>) -> f32 {
    let value = b * 2.0;
    let d = dot(a, a) + dot(b, b) + dot(c, c) + length(a) + dot(b, b) + dot(value, value);
    let e = distance(a, a) + distance(b, b) + min(a.x, a.y) + min(min(b.x, b.y), b.z) + min(min(c.x, c.y), min(c.z, c.w));
    let value_1 = c + 1.0;
    let g = max(a.x, a.y) + max(max(b.x, b.y), b.z) + max(max(value_1.x, value_1.y), max(value_1.z, value_1.w));
    let h = a.x + a.y + (b.x + b.y + b.z) + (c.x + c.y + c.z + c.w);
    return d + e + g * h + a.x * a.y + b.x * b.y * b.z + c.x * c.y * c.z * c.w;
}

fn user_shapes(b: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let c = abs(b) + min(b, n) + max(b, n) + clamp(b, vec3<f32>(0.0), n) + floor(b) + ceil(b) + trunc(b);
    let d = b - trunc(b) + fract(b) + 1.0 / b + pow(b, vec3<f32>(2.0)) + exp(b) + fma(b, n, c);
    let e = cross(b, n) + normalize(b) + mix(b, n, 0.25) + reflect(b, n);
    return c + d + e;
}

fn user_resized(a: vec2<f32>) -> vec4<f32> {
    let b = vec3<f32>(a, 1.0);
    let c = vec4<f32>(b, 2.0);
    return vec4<f32>(vec3<f32>(c.xyz.xy, 0.0), 1.0);
}
