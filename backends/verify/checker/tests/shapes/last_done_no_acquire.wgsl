// entry: main; fragments: 2; sc: holds; relaxed: race
// why: The last arrival has no fence after its addition, so its reads are not ordered after what it observes.
// after: NVIDIA cuda-samples threadFenceReduction (__threadfence only before the ticket)
@coherent @group(0) @binding(0) var<storage, read_write> part: array<u32, 2>;
@group(0) @binding(1) var<storage, read_write> done: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> total: array<u32, 1>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    part[id.x] = id.x + 1u;
    memory_fence();
    if atomicAdd(&done, 1u) != 1u { return; }
    total[0] = part[0] + part[1];
}
