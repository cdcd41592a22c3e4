// Atomic operations of one invocation, so results are deterministic. Compared exactly.

struct Header {
    count: atomic<u32>,
    lowest: atomic<i32>,
    items: array<atomic<u32>>,
}

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
@group(0) @binding(2) var<storage, read_write> header: Header;

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 10u; i++) {
        let at = i * 12u;
        results[at] = atomicAdd(&header.count, words[i]);
        results[at + 1u] = atomicSub(&header.items[i], 3u);
        results[at + 2u] = atomicMin(&header.items[0], words[i]);
        results[at + 3u] = atomicMax(&header.items[1], words[i]);
        results[at + 4u] = atomicAnd(&header.items[2], words[i]);
        results[at + 5u] = atomicOr(&header.items[3], words[i]);
        results[at + 6u] = atomicXor(&header.items[4], words[i]);
        results[at + 7u] = atomicExchange(&header.items[5], words[i]);
        results[at + 8u] = bitcast<u32>(atomicMin(&header.lowest, bitcast<i32>(words[i])));
        let exchange = atomicCompareExchangeWeak(&header.items[6], words[max(i, 1u) - 1u], words[i]);
        results[at + 9u] = exchange.old_value;
        results[at + 10u] = u32(exchange.exchanged);
        atomicStore(&header.items[7], words[i]);
        results[at + 11u] = atomicLoad(&header.items[7]);
    }
}
