@group(0) @binding(0) var<storage, read_write> u: array<u32>;
@group(0) @binding(1) var<storage, read_write> s: array<i32>;
@group(0) @binding(2) var<storage, read_write> f: array<f32>;

@compute @workgroup_size(1)
fn main() {
    let x = f[0];
    let v = vec4<f32>(f[1], f[2], f[3], f[4]);
    u[0] = u32(x) + u32(saturate(x) * 255.0) + u32(clamp(x, 0.0, 7.0));
    s[0] = i32(x) + i32(floor(clamp(x, -8.0, 8.0))) + i32(u[1]);
    let a = vec4<u32>(v);
    let b = vec4<i32>(v);
    u[2] = a.x + u32(b.y) + u32(x > 1.0);
    f[5] = f32(u[3]) + f32(s[1]) + f32(x > 0.0);
    u[4] = bitcast<u32>(x) + bitcast<u32>(s[2]);
    s[3] = bitcast<i32>(x) + bitcast<i32>(u[5]);
    f[6] = bitcast<f32>(u[6]) + bitcast<f32>(s[4]);
    let w = bitcast<vec4<u32>>(v);
    u[7] = w.x ^ w.y ^ w.z ^ w.w;
    u[8] = select(u32(bool(u[9])), 3u, bool(x));
    f[7] = bitcast<f32>(0x7f800001u ^ u[10]);
}
