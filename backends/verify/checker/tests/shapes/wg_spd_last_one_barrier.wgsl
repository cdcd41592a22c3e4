// entry: main; fragments: 4; sc: race; relaxed: race
// why: Only invocation 0 is ordered after the other workgroup. workgroupBarrier passes on workgroup memory only, so invocation 1 reads the mip unordered.
// after: single pass downsampler whose second barrier does not affect storage
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
    if arrived == 1u { top[l] = mip[l] + mip[l + 2u]; }
}
