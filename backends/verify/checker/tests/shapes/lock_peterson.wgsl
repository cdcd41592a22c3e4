// entry: main; fragments: 2; sc: holds; relaxed: race
// why: Each invocation stores its flag and loads the other's. Acquire-release fences permit both loads to miss both stores (store buffering), so both may enter.
// after: Peterson 1981
@group(0) @binding(0) var<storage, read_write> flag: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> turn: atomic<u32>;
@coherent @group(0) @binding(2) var<storage, read_write> sum: u32;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let other = 1u - id.x;
    atomicStore(&flag[id.x], 1u);
    atomicStore(&turn, other);
    memory_fence();
    loop { if atomicLoad(&flag[other]) == 0u || atomicLoad(&turn) == id.x { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&flag[id.x], 0u);
}
fn holds() -> bool { return sum == 2u; }
