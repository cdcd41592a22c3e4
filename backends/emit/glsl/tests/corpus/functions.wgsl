@group(0) @binding(0) var<storage, read_write> u: array<u32>;
@group(0) @binding(1) var<storage, read_write> s: array<i32>;
@group(0) @binding(2) var<storage, read_write> f: array<f32>;

@compute @workgroup_size(1)
fn floats() {
    let x = f[0];
    let y = f[1];
    let v = vec3<f32>(x, y, 1.0);
    let w = vec3<f32>(y, x, 2.0);
    f[2] = abs(x) + min(x, y) + max(x, y) + clamp(x, 0.0, 1.0) + clamp(x, y, 3.0) + saturate(y);
    f[3] = sin(x) + cos(x) + tan(x) + asin(x) + acos(x) + atan(x) + atan2(y, x) + sinh(x) + cosh(x) + tanh(x);
    f[4] = asinh(x) + acosh(x) + atanh(x) + radians(x) + degrees(y);
    f[5] = ceil(x) + floor(x) + round(x) + fract(x) + trunc(x) + ldexp(x, 3);
    f[6] = exp(x) + exp2(x) + log(x) + log2(x) + pow(x, y) + sqrt(x) + inverseSqrt(y);
    f[7] = dot(v, w) + length(v) + distance(v, w) + sign(x) + fma(x, y, 2.0) + mix(x, y, 0.5) + step(x, y) + smoothstep(0.0, 1.0, x);
    let c = cross(v, w) + normalize(v) + faceForward(v, w, v) + reflect(v, w) + refract(v, w, 0.5) + mix(v, w, x) + sign(v);
    f[8] = c.x + c.y + c.z + quantizeToF16(x);
    let chosen = select(v, w, v < w);
    f[9] = chosen.x + select(x, y, x < y);
}

@compute @workgroup_size(1)
fn integers() {
    let a = u[0];
    let c = s[0];
    u[1] = countOneBits(a) + firstTrailingBit(a) + firstLeadingBit(a) + countLeadingZeros(a) + countTrailingZeros(a) + reverseBits(a);
    s[1] = countOneBits(c) + firstTrailingBit(c) + firstLeadingBit(c) + countLeadingZeros(c) + countTrailingZeros(c) + reverseBits(c);
    u[2] = extractBits(a, 3u, 5u) + extractBits(a, u[3], u[4]) + insertBits(a, 7u, 0u, 3u) + insertBits(a, u[5], u[3], u[4]);
    s[2] = extractBits(c, 3u, 5u) + abs(c) + sign(c) + min(c, 3) + max(c, 4) + clamp(c, -1, 1) + clamp(c, s[3], s[4]);
    u[6] = abs(a) + min(a, 3u) + max(a, 4u) + clamp(a, 1u, 5u);
    let v = vec2<u32>(a, u[7]);
    let n = countOneBits(v) + firstLeadingBit(v);
    u[8] = n.x + n.y + dot(v, n);
}

@compute @workgroup_size(1)
fn packing() {
    let v = vec4<f32>(f[0], f[1], f[2], f[3]);
    u[0] = pack4x8unorm(v) ^ pack4x8snorm(v) ^ pack2x16unorm(v.xy) ^ pack2x16snorm(v.zw) ^ pack2x16float(v.xy);
    let w = unpack4x8unorm(u[1]) + unpack4x8snorm(u[2]);
    let h = unpack2x16unorm(u[3]) + unpack2x16snorm(u[4]) + unpack2x16float(u[5]);
    f[4] = w.x + w.y + w.z + w.w + h.x + h.y;
    let bytes = unpack4xU8(u[6]);
    let words = unpack4xI8(u[7]);
    u[8] = pack4xU8(bytes) + pack4xI8(words) + pack4xU8Clamp(bytes + 200u) + pack4xI8Clamp(words - 200);
}
