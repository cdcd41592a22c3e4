// entry: main; fragments: 2; sc: wrong; relaxed: wrong
// why: Invocation 0 may add its workgroup's count before invocation 1 has counted, so the total is too small.
// after: stream compaction without the first barrier
@group(0) @binding(0) var<storage, read_write> total: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> items: array<u32, 4>;
var<workgroup> count: atomic<u32>;
var<workgroup> base: u32;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    let rank = atomicAdd(&count, 1u);
    if l == 0u { base = atomicAdd(&total, atomicLoad(&count)); }
    workgroupBarrier();
    items[base + rank] = 1u;
}
fn holds() -> bool { return atomicLoad(&total) == 2u; }
