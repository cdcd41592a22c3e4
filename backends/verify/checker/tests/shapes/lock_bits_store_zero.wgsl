// entry: main; fragments: 3; sc: race; relaxed: race
// why: The release stores 0 to the whole word and so releases the other bit too, whose holder then shares its counter.
// after: bit lock that is released by a store
@group(0) @binding(0) var<storage, read_write> locks: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sums: array<u32, 2>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let at = id.x & 1u;
    let bit = 1u << at;
    loop { if (atomicOr(&locks, bit) & bit) == 0u { break; } }
    memory_fence();
    sums[at] += 1u;
    memory_fence();
    atomicStore(&locks, 0u);
}
