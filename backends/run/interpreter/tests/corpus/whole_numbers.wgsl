// Integers: operators, conversions and bit functions. Compared exactly.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

var<private> next: u32;

fn put(word: u32) {
    results[next] = word;
    next += 1u;
}

fn put_vector(v: vec3<u32>) {
    put(v.x);
    put(v.y);
    put(v.z);
}

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 30u; i++) {
        let a = words[i];
        let b = words[i + 1u];
        let c = bitcast<i32>(a);
        let d = bitcast<i32>(b);
        put(a + b);
        put(a - b);
        put(a * b);
        put(a / b);
        put(a % b);
        put(bitcast<u32>(c / d));
        put(bitcast<u32>(c % d));
        put(bitcast<u32>(-c));
        put(a << (b & 31u));
        put(a >> (b & 31u));
        put(bitcast<u32>(c >> (b & 31u)));
        put((a & b) ^ (a | ~b));
        put(u32(a < b) | (u32(a <= b) << 1u) | (u32(c < d) << 2u) | (u32(c >= d) << 3u) | (u32(a == b) << 4u));
        put(select(a, b, c > d));
        put(min(a, b) ^ max(a, b) ^ bitcast<u32>(min(c, d)));
        put(bitcast<u32>(clamp(c, -5, 5)) + clamp(a, 2u, 9u));
        put(bitcast<u32>(abs(c)) ^ bitcast<u32>(sign(d)));
        put(countOneBits(a) | (countLeadingZeros(a) << 8u) | (countTrailingZeros(a) << 16u));
        put(reverseBits(a));
        put(firstLeadingBit(a) ^ bitcast<u32>(firstLeadingBit(c)));
        put(firstTrailingBit(b));
        put(extractBits(a, b & 15u, 7u));
        put(bitcast<u32>(extractBits(c, 3u, b & 31u)));
        put(insertBits(a, b, 4u, b & 15u));
        put(dot4U8Packed(a, b));
        put(bitcast<u32>(dot4I8Packed(a, b)));
        let v = vec3<u32>(a, b, a ^ b);
        put_vector(v / vec3<u32>(3u, words[0], b));
        put_vector(v.zxy * 2u + (v << vec3<u32>(1u, 2u, 3u)));
        put_vector(select(v, v.yzx, v < v.zxy));
        put(u32(all(v == v)) | (u32(any(v < v.yzx)) << 1u));
        put(dot(v, v.yzx));
        put(pack4xU8(vec4<u32>(a, b, 300u, 7u)) ^ pack4xU8Clamp(vec4<u32>(a, b, 300u, 7u)));
        put(pack4xI8(vec4<i32>(c, d, 300, -7)) ^ pack4xI8Clamp(vec4<i32>(c, d, 300, -7)));
        put(unpack4xU8(a).w ^ bitcast<u32>(unpack4xI8(a).z));
        put(u32(bool(a)) + u32(bool(d)));
    }
}
