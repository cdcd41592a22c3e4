// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: A probe moves on only if the slot holds another key. After a failure for no reason the same slot is tried again.
// after: nosferalatu/SimpleGPUHashTable (linear probing by compare-and-swap)
@group(0) @binding(0) var<storage, read_write> keys: array<atomic<u32>, 4>;
@group(0) @binding(1) var<storage, read_write> counts: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(1) fn main() {
    atomicAdd(&n, 1u);
    var slot = 1u;
    loop {
        let r = atomicCompareExchangeWeak(&keys[slot], 0u, 9u);
        if r.exchanged || r.old_value == 9u { break; }
        if r.old_value != 0u { slot = (slot + 1u) & 3u; }
    }
    atomicAdd(&counts[slot], 1u);
}
fn holds() -> bool { return atomicLoad(&counts[1]) == atomicLoad(&n) && atomicLoad(&keys[2]) == 0u; }
