// Functions with an error bound in WGSL, also of vectors and matrices. Compared within 1/2048 of the magnitude.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<f32>;

var<private> next: u32;

fn put(x: f32) {
    results[next] = x;
    next += 1u;
}

fn put3(v: vec3<f32>) {
    put(v.x);
    put(v.y);
    put(v.z);
}

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 20u; i++) {
        let x = f32(i32(words[i] % 401u) - 200) * 0.0125;
        let y = f32(words[i + 1u] % 1000u) * 0.004 + 0.125;
        let u = x / 2.6;
        put(x / y);
        put(x % y);
        put(sqrt(y));
        put(inverseSqrt(y));
        put(exp(x));
        put(exp2(x));
        put(log(y));
        put(log2(y));
        put(pow(y, x));
        put(sin(x));
        put(cos(x));
        put(tan(u));
        put(asin(u));
        put(acos(u));
        put(atan(x));
        put(atan2(x, y));
        put(sinh(x));
        put(cosh(x));
        put(tanh(x));
        put(asinh(x));
        put(acosh(y + 1.0));
        put(atanh(u));
        put(radians(x));
        put(degrees(x));
        put(fma(x, y, 1.0));
        put(mix(x, y, 0.25));
        put(smoothstep(-1.0, 1.0, x));
        let v = vec3<f32>(x, y, 0.5);
        let w = vec3<f32>(y, 0.25, x);
        put(dot(v, w));
        put(length(v));
        put(distance(v, w));
        put3(normalize(v));
        put3(cross(v, w));
        put3(reflect(v, normalize(w)));
        put3(refract(normalize(v), normalize(w), 0.75));
        put3(faceForward(v, w, v.zyx));
        put3(mix(v, w, vec3<f32>(0.25, 0.5, 0.75)));
        put3(mix(v, w, 0.5));
        put(unpack4x8unorm(words[i]).y + unpack4x8snorm(words[i]).z);
        put(unpack2x16unorm(words[i]).y + unpack2x16snorm(words[i]).x);
        let m = mat3x3<f32>(v, w, v.zxy);
        put3(m * v);
        put3(v * m);
        put3((m * transpose(m))[1]);
        put(determinant(m));
        put3((m + m * 2.0 - m)[2]);
        let t = mat2x3<f32>(v, w);
        put3(t * vec2<f32>(x, y));
        put((w * t).y);
    }
}
