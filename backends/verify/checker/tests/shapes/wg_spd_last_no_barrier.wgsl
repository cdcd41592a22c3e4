// entry: main; fragments: 4; sc: race; relaxed: race
// why: Invocation 0 counts its workgroup as done although invocation 1 may not have stored yet.
// after: single pass downsampler without a barrier before the counter
@coherent @group(0) @binding(0) var<storage, read_write> mip: array<u32, 4>;
@group(0) @binding(1) var<storage, read_write> done: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> top: array<u32, 4>;
var<workgroup> arrived: u32;
fn memory_fence() {}
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(global_invocation_id) id: vec3u) {
    mip[id.x] = 1u;
    if l == 0u { memory_fence(); arrived = atomicAdd(&done, 1u); memory_fence(); }
    workgroupBarrier();
    storageBarrier();
    if arrived == 1u { top[l] = mip[l] + mip[l + 2u]; }
}
