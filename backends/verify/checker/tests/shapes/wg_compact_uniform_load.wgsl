// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: workgroupUniformLoad has a barrier before and after its load, so all invocations read the base after it is written.
// after: WGSL workgroupUniformLoad
@group(0) @binding(0) var<storage, read_write> total: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> items: array<u32, 4>;
var<workgroup> count: atomic<u32>;
var<workgroup> base: u32;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    let rank = atomicAdd(&count, 1u);
    workgroupBarrier();
    if l == 0u { base = atomicAdd(&total, atomicLoad(&count)); }
    items[workgroupUniformLoad(&base) + rank] = 1u;
}
fn holds() -> bool {
    for (var i = 0u; i < atomicLoad(&total); i++) { if items[i] != 1u { return false; } }
    return atomicLoad(&total) >= 2u;
}
