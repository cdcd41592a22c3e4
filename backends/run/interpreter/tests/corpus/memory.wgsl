// Variables, pointers, structures, padding, arrays, loops, switches and short-circuit evaluation. Compared exactly.

struct Inner {
    a: u32,
    b: vec3<f32>,
    c: array<u32, 3>,
}

struct Outer {
    first: vec2<u32>,
    inner: array<Inner, 2>,
    turn: mat3x2<f32>,
    last: u32,
}

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
@group(0) @binding(2) var<storage, read_write> outer: array<Outer>;
@group(0) @binding(3) var<storage, read> fixed: Outer;
@group(0) @binding(4) var<uniform> fixed_turn: mat4x2<f32>;

var<private> next: u32;
var<private> table: array<u32, 4> = array<u32, 4>(3u, 5u, 7u, 11u);
const PRIMES = array<u32, 3>(2u, 3u, 5u);

fn put(word: u32) {
    results[next] = word;
    next += 1u;
}

fn bump(value: ptr<function, u32>) -> u32 {
    *value += 1u;
    return *value;
}

fn swap(keys: ptr<function, array<u32, 4>>, i: u32, j: u32) {
    let t = (*keys)[i];
    (*keys)[i] = (*keys)[j];
    (*keys)[j] = t;
}

fn early(n: u32) -> u32 {
    for (var i = 0u; i < 10u; i++) {
        if i == n {
            return i * 100u;
        }
        if i % 2u == 0u {
            continue;
        }
        put(i);
    }
    return 7u;
}

fn chosen(n: u32) -> u32 {
    var sum = 0u;
    switch n {
        case 0u: {
            sum = 1u;
        }
        case 1u, 2u: {
            if n == 2u {
                break;
            }
            sum = 2u;
        }
        default: {
            sum = 3u;
        }
    }
    return sum;
}

fn noted(value: bool, note: u32) -> bool {
    put(note);
    return value;
}

@compute @workgroup_size(1)
fn main() {
    var keys: array<u32, 4>;
    for (var i = 0u; i < 4u; i++) {
        keys[i] = words[i];
        var fresh: array<u32, 2>;
        fresh[i & 1u] += i;
        put(fresh[0] + 10u * fresh[1]);
    }
    swap(&keys, 1u, 3u);
    put(keys[1] ^ keys[3]);
    var n = 4u;
    put(bump(&n) + bump(&n) * 10u);
    table[n & 3u] = 99u;
    put(table[0] + table[1] + table[2] + table[3]);
    for (var i = 0u; i < 3u; i++) {
        put(PRIMES[i]);
        put(early(i * 3u));
        put(chosen(i));
    }
    put(early(20u));
    put(chosen(9u));
    outer[1].inner[1].b = vec3<f32>(1.0, 2.0, 3.0);
    outer[1].inner[n & 1u].c[2] = 17u;
    outer[1].turn[2] = vec2<f32>(4.0, 5.0);
    outer[0] = fixed;
    outer[0].last += fixed.inner[1].c[1];
    outer[0].last ^= bitcast<u32>(fixed_turn[2].y);
    let copy = outer[1];
    put(copy.last ^ copy.inner[0].a);
    put(bitcast<u32>(outer[0].inner[n & 1u].b[n % 3u]));
    put(arrayLength(&results) ^ arrayLength(&outer));
    put(u32(noted(true, 1u) && noted(false, 2u) || noted(true, 3u)));
    put(u32(noted(false, 4u) && noted(true, 5u)));
    var i = 0u;
    loop {
        if i > 5u {
            break;
        }
        i += 2u;
        continuing {
            put(i);
            break if i == 4u;
        }
    }
    var v = vec4<u32>(1u, 2u, 3u, 4u);
    v[n & 3u] = 9u;
    v.x += v[(n + 1u) & 3u];
    put(v.x + v.y * 10u + v.z * 100u + v.w * 1000u);
    while i > 0u {
        i -= 1u;
        put(i);
    }
}
