// entry: main; fragments: 4; sc: holds; relaxed: holds
// why: storageBarrier orders both stores of a workgroup before the addition; device fences around it order them before the reads of the last workgroup.
// after: FidelityFX SPD; JolifantoBambla/webgpu-spd
@coherent @group(0) @binding(0) var<storage, read_write> mip: array<u32, 4>;
@group(0) @binding(1) var<storage, read_write> done: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> top: array<u32, 4>;
var<workgroup> arrived: u32;
fn memory_fence() {}
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(global_invocation_id) id: vec3u) {
    mip[id.x] = 1u;
    storageBarrier();
    if l == 0u { memory_fence(); arrived = atomicAdd(&done, 1u); memory_fence(); }
    workgroupBarrier();
    storageBarrier();
    if arrived == 1u { top[l] = mip[l] + mip[l + 2u]; }
}
fn holds() -> bool { return top[0] == 2u && top[1] == 2u; }
