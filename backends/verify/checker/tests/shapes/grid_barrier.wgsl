// entry: main; fragments: 2; sc: holds; relaxed: holds
// why: Each workgroup writes, fences, arrives, waits for both arrivals and fences before it reads. It ends if all workgroups run concurrently, which WebGPU does not promise.
// after: Xiao and Feng, inter-block GPU communication via fast barrier synchronization (IPDPS 2010)
@coherent @group(0) @binding(0) var<storage, read_write> data: array<u32, 2>;
@group(0) @binding(1) var<storage, read_write> arrived: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 2>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    data[id.x] = id.x + 1u;
    memory_fence();
    atomicAdd(&arrived, 1u);
    loop { if atomicLoad(&arrived) == 2u { break; } }
    memory_fence();
    seen[id.x] = data[1u - id.x];
}
fn holds() -> bool { return seen[0] == 2u && seen[1] == 1u; }
