// entry: main; fragments: 2; sc: holds; relaxed: holds
// why: The exchanges of `turn` are ordered; fences around them make the second invocation observe the flag of the first, so it waits.
// after: Anthony Williams, Peterson's lock with C++0x atomics (2008)
@group(0) @binding(0) var<storage, read_write> flag: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> turn: atomic<u32>;
@coherent @group(0) @binding(2) var<storage, read_write> sum: u32;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let other = 1u - id.x;
    atomicStore(&flag[id.x], 1u);
    memory_fence();
    atomicExchange(&turn, other);
    memory_fence();
    loop { if atomicLoad(&flag[other]) == 0u || atomicLoad(&turn) == id.x { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&flag[id.x], 0u);
}
fn holds() -> bool { return sum == 2u; }
