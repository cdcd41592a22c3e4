// Constructs that a printer of another language must rewrite: the order of evaluation, loops with `continuing`, switches, names, copies of
// values, integers and built-in functions at their limits. `x` is 1, and no compiler knows it. Compared exactly.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

var<private> touched: u32 = 5u;
const TABLE = array<u32, 5>(3u, 1u, 4u, 1u, 5u);

struct Pair {
    first: u32,
    rest: array<u32, 3>,
}

fn advance(p: ptr<function, u32>) -> u32 {
    *p = *p * 3u + 1u;
    return *p;
}

fn is_above(p: ptr<function, u32>, limit: u32) -> bool {
    *p += 1u;
    return *p > limit;
}

fn touch() -> u32 {
    touched += 2u;
    return touched;
}

fn turned(pair: Pair) -> Pair {
    var copy = pair;
    copy.rest[1] = copy.first;
    copy.first = 9u;
    return copy;
}

fn operands_from_left_to_right(x: u32) -> u32 {
    var a = x;
    let r = advance(&a) * 100u + advance(&a);
    let private_order = touch() * 100u + touch() * 10u + touched * x;
    return r * 1000u + a * 100u + private_order;
}

fn short_circuit(x: u32) -> u32 {
    var a = x;
    if is_above(&a, 100u) && is_above(&a, 0u) {
        a = 0u;
    }
    if !is_above(&a, 100u) || is_above(&a, 0u) {
        a += 10u;
    }
    return a;
}

fn copies_are_values(x: u32) -> u32 {
    var a = x;
    let before = a;
    a = 50u;
    let between = a;
    a = 90u;
    var pair = Pair(x, array<u32, 3>(1u, 2u, 3u));
    let other = turned(pair);
    pair.rest[2] = 7u;
    var table = TABLE;
    table[x] = 8u;
    let copy = table;
    table[x + 1u] = 9u;
    let of_pairs = other.first * 1000u + other.rest[1] * 100u + pair.rest[2] * 10u + other.rest[2];
    return before * 31u + between * 37u + a * 41u + of_pairs + copy[1] * 7u + copy[2] * 11u + table[2] * 13u + TABLE[x + 3u];
}

fn indices_are_clamped(x: u32) -> u32 {
    var table = array<u32, 4>(1u, 2u, 3u, 4u);
    table[min(x * 77u, 3u)] = 6u;
    var matrix = mat2x2<f32>(1.0, 2.0, 3.0, 4.0);
    matrix[x][0] = 9.0;
    matrix[0] += vec2<f32>(1.0);
    return table[3] + u32(determinant(matrix) + 20.0) * 10u + u32(matrix[1].x) * 1000u;
}

fn continuing_with_an_end(x: u32) -> u32 {
    var sum = 0u;
    var i = 0u;
    loop {
        if (i & 1u) == 0u {
            continue;
        }
        sum += i;
        continuing {
            let next = i + x;
            i = next;
            break if i == 7u;
        }
    }
    return sum;
}

fn nested_continuing(x: u32) -> u32 {
    var sum = 0u;
    var i = 0u;
    loop {
        var j = 0u;
        loop {
            if j == 2u {
                break;
            }
            if j == x {
                continue;
            }
            sum += 1u;
            continuing {
                j++;
                sum += 10u;
            }
        }
        if i == 1u {
            continue;
        }
        sum += 100u;
        continuing {
            i += x;
            sum += 1000u;
            break if i >= 3u;
        }
    }
    return sum;
}

fn variables_of_a_loop_begin_at_zero(x: u32) -> u32 {
    var sum = 0u;
    for (var i = 0u; i < 4u; i++) {
        var inside: u32;
        var list: array<u32, 3>;
        inside += i;
        list[i % 3u] += 5u;
        sum = sum * 10u + inside + list[0] + list[1] + list[2] * x;
    }
    return sum;
}

fn condition_with_an_effect(x: u32) -> u32 {
    var a = x;
    var count = 0u;
    while !is_above(&a, 9u) {
        count++;
    }
    return count * 100u + a;
}

fn switches(x: u32) -> u32 {
    var sum = 0u;
    switch x + 1u {
        case 1u { sum = 1u; }
        case 7u, default { sum = 9u; }
        case 2u { sum = 22u; }
    }
    for (var i = 0u; i < 6u; i++) {
        switch i {
            case 2u {
                switch x {
                    case 1u { break; }
                    default { sum += 1000u; }
                }
                sum += 7u;
            }
            case 4u {
                for (var j = 0u; j < 5u; j++) {
                    if j == 3u {
                        break;
                    }
                    sum += 50u;
                }
            }
            default { sum += 1u; }
        }
        switch x {
            default {
                if i == 2u {
                    continue;
                }
                sum += i;
            }
        }
        sum += 100u;
    }
    return sum;
}

fn continue_in_a_switch(x: u32) -> u32 {
    var sum = 0u;
    var i = 0u;
    loop {
        if i > 9u {
            break;
        }
        switch i {
            case 1u, 3u { continue; }
            case 5u: { break; }
            default { sum = sum * 3u + i; }
        }
        sum += x;
        continuing {
            i++;
        }
    }
    return sum;
}

fn return_in_a_switch(x: u32) -> u32 {
    for (var i = 0u; i < 9u; i++) {
        switch i {
            case 4u { return 40u + x; }
            default {}
        }
    }
    return 1u;
}

fn results_are_dropped(x: u32) -> u32 {
    var a = x;
    _ = advance(&a);
    _ = a * 2u;
    return a;
}

// Names that are keywords or functions of GLSL, or that a printer could use itself.
fn uniforms_(a: u32) -> u32 { return a + 3u; }
fn wgsl_remainder(a: u32, b: u32) -> u32 { return a * 10u + b; }
fn sample(input: u32) -> u32 { return input + 1u; }
fn half(output: u32) -> u32 {
    let superp = sample(output);
    let noise = superp * 2u;
    let texture2D = noise;
    let double = texture2D + 1u;
    let a__b = double;
    let gl_FragCoord = a__b;
    let hvec2 = gl_FragCoord;
    let fixed = hvec2;
    let flat = fixed;
    let void = flat;
    return void;
}

fn names(x: u32) -> u32 {
    let main = half(x);
    let long = main;
    let inout = long;
    let in = inout;
    let out = in;
    let hvec3 = out;
    let isampler2D = hvec3;
    let iimage2D = isampler2D;
    return iimage2D + wgsl_remainder(x, 2u) * 100u + (x * 17u) % (x + 4u) + uniforms_(x) * 1000u;
}

fn integers_wrap(x: u32) -> u32 {
    let least = i32(x) * 2147483647 + 1;
    let whole = u32(least) ^ (u32(-least) >> 1u) ^ (u32(abs(least)) >> 2u) ^ (u32(least - 1) >> 3u);
    let eight = -i32(x) * 8;
    let shifted = u32(eight >> 1u) ^ u32(eight << (x + 30u)) ^ (1u << (x + 32u)) ^ (0x80000000u >> (x * 33u));
    return whole ^ shifted;
}

fn divisors(x: u32) -> u32 {
    let seven = vec3<i32>(-7, 7, -8) * i32(x);
    let rest = seven % vec3<i32>(3, -3, i32(x) - 1);
    let quotient = seven / vec3<i32>(2, i32(x) - 1, -1);
    let least = i32(x) * 2147483647 + 1;
    let of_least = u32(least / -i32(x)) ^ u32(least % -i32(x));
    return u32(rest.x + 10) + u32(rest.y + 10) * 100u + u32(rest.z + 10) * 10000u + u32(quotient.x + 10) * 3u
        + u32(quotient.y + 10) * 5u + u32(quotient.z + 10) * 7u + of_least;
}

fn bits(x: u32) -> u32 {
    let a = extractBits(0xabcdef12u, 8u * x, 12u);
    let b = extractBits(0xabcdef12u, 40u * x, 4u);
    let c = insertBits(0u, 0xffu, 28u * x, 9u);
    let d = extractBits(0xffu, 3u, 0u * x);
    let e = u32(extractBits(i32(0x80u), 4u, 4u * x));
    let leading = firstLeadingBit(x * 0u) + 1u + u32(firstLeadingBit(-i32(x) * 5)) * 100u + u32(firstLeadingBit(-i32(x)) + 1) * 1000u;
    return a ^ b ^ c ^ d ^ (e << 4u) ^ (leading + firstTrailingBit(x * 8u) * 10u);
}

fn packed(x: u32) -> u32 {
    let f = f32(x);
    let unit = pack4x8unorm(vec4<f32>(f * 0.5, 2.0, -1.0, 0.25)) ^ pack2x16unorm(vec2<f32>(f * 0.3, 0.7));
    let signed = pack2x16snorm(vec2<f32>(-f, 0.3)) ^ pack4x8snorm(vec4<f32>(-f, 0.5, 2.0, 0.1));
    let bytes = unpack4x8snorm(0x80ff7f01u * x);
    let halves = unpack2x16snorm(0x80007fffu * x);
    let unpacked = u32((bytes.w + 2.0) * 100.0) + u32((bytes.x + 2.0) * 1000.0) * 7u + u32((halves.y + 3.0) * 10.0) * 1000000u;
    let products = dot4U8Packed(0x01020304u * x, 0x05060708u) + u32(dot4I8Packed(0xff020304u * x, 0x05060708u));
    let float16 = pack2x16float(vec2<f32>(f, 0.333)) ^ u32(unpack2x16float(0x3c01c003u * x).x * 4096.0);
    return unit ^ signed ^ unpacked ^ products ^ float16;
}

fn parts_of_floats(x: u32) -> u32 {
    let f = f32(x) * -6.75;
    let two = frexp(f);
    let parts = modf(f);
    let of_parts = u32(two.exp) * 1000u + u32(-two.fract * 100.0) + u32(-parts.whole) * 100000u + u32(-parts.fract * 100.0) * 10u;
    return of_parts ^ bitcast<u32>(ldexp(f32(x) * 1.5, -3)) ^ bitcast<u32>(ldexp(f32(x), 20));
}

fn selected(x: u32) -> u32 {
    let mask = vec3<bool>(x == 1u, x == 2u, x == 1u);
    let v = select(vec3<u32>(1u, 2u, 3u), vec3<u32>(7u, 8u, 9u), mask);
    let n = select(v, vec3<u32>(0u), all(mask));
    let f = f32(x);
    let around = vec3<f32>(-f, 0.0 * f, 2.0 * f);
    let s = sign(around) + 2.0;
    let t = step(vec3<f32>(0.0), around);
    let r = round(vec3<f32>(f * 0.5, f * 1.5, f * -2.5));
    let q = saturate(vec3<f32>(-f, f * 0.5, f * 3.0));
    let floats = u32(s.x + s.y * 10.0 + s.z * 100.0) + u32(t.x * 4.0 + t.y * 2.0 + t.z) * 1000u + u32(r.x + r.y * 10.0 + r.z + 5.0) * 10000u
        + u32(q.y * 2.0 + q.z * 4.0 + q.x) * 1000000u;
    return n.x * 100u + n.y * 10u + n.z + u32(any(mask)) * 1000u + floats;
}

fn matrices(x: u32) -> u32 {
    let f = f32(x);
    let m = mat3x2<f32>(f, 2.0, 3.0, 4.0, 5.0, 6.0);
    let v = m * vec3<f32>(1.0, 10.0, 100.0);
    let w = vec2<f32>(1.0, 10.0) * m;
    return u32(v.x) * 1000u + u32(v.y) + u32(w.z) * 7u + u32(transpose(m)[1][2]);
}

@compute @workgroup_size(1)
fn main() {
    let x = words[1];
    results[0] = operands_from_left_to_right(x);
    results[1] = short_circuit(x);
    results[2] = copies_are_values(x);
    results[3] = indices_are_clamped(x);
    results[4] = continuing_with_an_end(x);
    results[5] = nested_continuing(x);
    results[6] = variables_of_a_loop_begin_at_zero(x);
    results[7] = condition_with_an_effect(x);
    results[8] = switches(x);
    results[9] = continue_in_a_switch(x);
    results[10] = return_in_a_switch(x);
    results[11] = results_are_dropped(x);
    results[12] = names(x);
    results[13] = integers_wrap(x);
    results[14] = divisors(x);
    results[15] = bits(x);
    results[16] = packed(x);
    results[17] = parts_of_floats(x);
    results[18] = selected(x);
    results[19] = matrices(x);
}
