@group(0) @binding(0) var<storage, read_write> u: array<u32>;
@group(0) @binding(1) var<storage, read_write> s: array<i32>;
@group(0) @binding(2) var<storage, read_write> f: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    let a = u[i];
    let b = u[i + 1u];
    let c = s[i];
    let d = s[i + 1u];
    let x = f[i];
    let y = f[i + 1u];
    u[0] = a + b * 3u - (a - b) - (a + (b + 1u));
    u[1] = a / b + a / 4u + a % b + a % 8u;
    u[2] = (a << b) | (a >> 3u) & 0xFFu ^ ~b;
    u[3] = a << (b & 31u);
    s[0] = c / d + c % d + c / 3 - -d;
    s[1] = -c * (c - d) + i32(-2147483648);
    s[2] = c >> b;
    f[0] = x % y + x / y - -x;
    f[1] = -(x + y) * 1e-5 + 1e16;
    let v = vec3<u32>(a, b, 7u);
    let w = vec3<u32>(b, a, 9u);
    let q = v / w + v % w + v * 2u + (v << w) + (v >> vec3<u32>(1u));
    u[4] = q.x + q.y + q.z;
    let sv = vec2<i32>(c, d);
    let sw = sv / sv.yx + sv % sv.yx;
    s[3] = sw.x + dot(sv + 1, sw);
    let fv = vec4<f32>(x, y, x, y);
    let fw = fv % fv.wzyx + fv * 2.0 - fv.xxyy;
    f[2] = dot(fv, fw);
    u[5] = u32(a < b) + u32(c >= d) + select(0u, 1u, x != y);
    let less = v < w;
    let both = less & (v != w) | (v == w);
    u[6] = select(1u, 2u, all(both)) + select(3u, 4u, any(less)) + u32(any(!less));
    let scalar = (a < b) & (c < d) | (x < y);
    u[7] = u32(scalar);
}
