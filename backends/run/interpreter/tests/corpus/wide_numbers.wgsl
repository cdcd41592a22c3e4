// 64-bit integers and atomics on them. Compared exactly.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u64>;
@group(0) @binding(2) var<storage, read_write> least: array<atomic<u64>>;

var<private> next: u32;

fn put(value: u64) {
    results[next] = value;
    next += 1u;
}

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 10u; i++) {
        let a = (u64(words[i]) << 32u) | u64(words[i + 1u]);
        let b = u64(words[i + 2u]) * 3lu + 1lu;
        let c = i64(a);
        let d = i64(b) - 5000000000li;
        put(a + b);
        put(a - b);
        put(a * b);
        put(a / b);
        put(a % b);
        put(u64(c / d));
        put(u64(c % d));
        put((a & b) ^ (a | ~b));
        put(a >> 5u);
        put(u64(c >> 7u));
        put(u64(-c));
        put(min(a, b) ^ max(a, b));
        put(u64(min(c, d)));
        put(u64(a < b) | (u64(c < d) << 1u) | (u64(a == b) << 2u));
        put(select(a, b, c > d));
        put(u64(u32(a)) + u64(i64(i32(words[i]))));
        put(atomicMin(&least[0], a));
        put(atomicMax(&least[1], a));
        put(atomicAdd(&least[2], b));
        put(atomicExchange(&least[3], a));
        put(atomicLoad(&least[3]));
    }
}
