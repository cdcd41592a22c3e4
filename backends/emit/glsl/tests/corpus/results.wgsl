@group(0) @binding(0) var<storage, read_write> u: array<u32>;
@group(0) @binding(1) var<storage, read_write> s: array<i32>;
@group(0) @binding(2) var<storage, read_write> f: array<f32>;

fn whole_part(value: vec3<f32>) -> vec3<f32> {
    let parts = modf(value);
    return parts.whole + parts.fract;
}

@compute @workgroup_size(1)
fn parts() {
    let x = f[0];
    let parts = modf(x);
    f[1] = parts.fract + parts.whole + modf(vec2<f32>(x, f[2])).fract.y + modf(vec4<f32>(x)).whole.w;
    f[3] = whole_part(vec3<f32>(x, 1.5, -2.5)).y;
    let number = frexp(x);
    f[4] = number.fract + ldexp(number.fract, number.exp);
    s[0] = number.exp + frexp(vec3<f32>(x, f[5], 0.0)).exp.z;
    var stored = frexp(vec2<f32>(x, f[6]));
    f[7] = stored.fract.x;
}

@compute @workgroup_size(1)
fn bytes() {
    u[0] = dot4U8Packed(u[1], u[2]);
    s[1] = dot4I8Packed(u[1], u[2]);
    f[8] = quantizeToF16(f[9]);
    let two = quantizeToF16(vec2<f32>(f[10], f[11]));
    let three = quantizeToF16(vec3<f32>(f[10], f[11], 1.0));
    let four = quantizeToF16(vec4<f32>(f[10], f[11], 1.0, 65520.0));
    f[12] = two.x + three.y + four.z;
}
