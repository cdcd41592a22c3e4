// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Each bit of the word is a lock. atomicOr takes it and atomicAnd releases that bit only. Invocations 0 and 2 share bit 0.
// after: suguruwataru/wgsl-loop (atomicOr lock); one lock bit per pixel
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
    atomicAnd(&locks, ~bit);
}
fn holds() -> bool { return sums[0] + sums[1] >= 2u && sums[1] == 1u && atomicLoad(&locks) == 0u; }
