// entry: main; fragments: 2,3; fill: counts=0,7; sc: holds; relaxed: holds
// why: The pass adds to one counter and clears only the other, which it does not use.
// after: double-buffered particle or draw counters
@group(0) @binding(0) var<storage, read_write> counts: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u { atomicStore(&counts[1], 0u); }
    atomicAdd(&n, 1u);
    atomicAdd(&counts[0], 1u);
}
fn holds() -> bool { return atomicLoad(&counts[0]) == atomicLoad(&n) && atomicLoad(&counts[1]) == 0u; }
