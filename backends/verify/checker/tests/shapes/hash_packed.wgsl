// entry: main; fragments: 2; sc: holds; relaxed: holds
// why: Key and value are one word, so a look-up finds both or none.
// after: hash tables with packed entries (Alcantara 2009)
@group(0) @binding(0) var<storage, read_write> entry: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> seen: array<u32, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        loop { if atomicCompareExchangeWeak(&entry, 0u, (9u << 16u) | 5u).exchanged { break; } }
    } else {
        let e = atomicLoad(&entry);
        if (e >> 16u) == 9u { seen[0] = 1u; seen[1] = e & 0xffffu; }
    }
}
fn holds() -> bool { return seen[0] == 0u || seen[1] == 5u; }
