// Floats: operators and functions with exact results, conversions and packing. Compared exactly.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

var<private> next: u32;

fn put(word: u32) {
    results[next] = word;
    next += 1u;
}

fn put_float(x: f32) {
    put(bitcast<u32>(x));
}

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 30u; i++) {
        let x = f32(i32(words[i] % 4001u) - 2000) * 0.0625;
        let y = f32(words[i + 1u] % 1000u) * 0.25 + 0.5;
        put_float(x + y);
        put_float(x - y);
        put_float(x * y);
        put_float(-x);
        put(u32(x < y) | (u32(x <= y) << 1u) | (u32(x == y) << 2u) | (u32(x > y) << 3u));
        put(bitcast<u32>(i32(x)));
        put(u32(x));
        put(u32(x * 1.0e9));
        put(bitcast<u32>(i32(y * -1.0e9)));
        put_float(f32(words[i]));
        put_float(f32(bitcast<i32>(words[i])));
        put(u32(bool(x)));
        put_float(floor(x));
        put_float(ceil(x));
        put_float(trunc(x));
        put_float(round(x));
        put_float(fract(x));
        put_float(abs(x));
        put_float(sign(x));
        put_float(min(x, y) + max(x, y));
        put_float(clamp(x, -1.5, 8.0));
        put_float(saturate(x));
        put_float(step(y, x));
        put_float(select(x, y, x > 0.0));
        let m = modf(x);
        put(u32(m.fract == x - trunc(x)));
        put_float(m.whole);
        let e = frexp(x);
        put_float(e.fract);
        put(bitcast<u32>(e.exp));
        put_float(ldexp(x, 3));
        put_float(quantizeToF16(x));
        put(pack4x8unorm(vec4<f32>(x * 0.01, y * 0.003, 0.4, 2.0)));
        put(pack4x8snorm(vec4<f32>(x * 0.01, y * 0.003, -0.4, -2.0)));
        put(pack2x16unorm(vec2<f32>(x * 0.01, 0.31)));
        put(pack2x16snorm(vec2<f32>(x * 0.01, -0.31)));
        put(pack2x16float(vec2<f32>(x, y)));
        put_float(unpack2x16float(0x3c01c003u + i).x);
        let v = vec3<f32>(x, y, 2.0);
        let w = v.zyx - v * 2.0;
        put_float(w.x + w.y);
        put(u32(any(v < w)) + u32(all(v <= v)));
    }
}
