// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: Invocation 1 reads the base without a barrier after invocation 0 writes it.
// after: stream compaction without the second barrier
@group(0) @binding(0) var<storage, read_write> total: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> items: array<u32, 4>;
var<workgroup> count: atomic<u32>;
var<workgroup> base: u32;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    let rank = atomicAdd(&count, 1u);
    workgroupBarrier();
    if l == 0u { base = atomicAdd(&total, atomicLoad(&count)); }
    items[base + rank] = 1u;
}
