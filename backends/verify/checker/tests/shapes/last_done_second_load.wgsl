// entry: main; fragments: 2; sc: race; relaxed: race
// why: Addition and test are apart, so both invocations can read the full count, and both write the total.
// after: last-workgroup reduction that loads the counter again
@coherent @group(0) @binding(0) var<storage, read_write> part: array<u32, 2>;
@group(0) @binding(1) var<storage, read_write> done: atomic<u32>;
@coherent @group(0) @binding(2) var<storage, read_write> total: array<u32, 1>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    part[id.x] = id.x + 1u;
    memory_fence();
    atomicAdd(&done, 1u);
    if atomicLoad(&done) != 2u { return; }
    memory_fence();
    total[0] = part[0] + part[1];
}
