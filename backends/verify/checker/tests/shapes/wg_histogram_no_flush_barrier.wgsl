// entry: main; fragments: 2,3; sc: wrong; relaxed: wrong
// why: A bin may be flushed before the other invocation has counted in it.
// after: radix sort histogram without a barrier before the flush
@group(0) @binding(0) var<storage, read_write> bins: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
var<workgroup> local: array<atomic<u32>, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    atomicStore(&local[l], 0u);
    workgroupBarrier();
    atomicAdd(&local[1u - l], 1u);
    atomicAdd(&bins[l], atomicLoad(&local[l]));
    atomicAdd(&n, 1u);
}
fn holds() -> bool { return atomicLoad(&bins[0]) + atomicLoad(&bins[1]) == atomicLoad(&n); }
