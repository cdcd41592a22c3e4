// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Barriers separate clearing, counting and flushing of the workgroup's bins; the global bins change by additions.
// after: radix sort histogram (bacpop/sparrowhawk; b0nes164/GPUSorting)
@group(0) @binding(0) var<storage, read_write> bins: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
var<workgroup> local: array<atomic<u32>, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    atomicStore(&local[l], 0u);
    workgroupBarrier();
    atomicAdd(&local[1u - l], 1u);
    workgroupBarrier();
    atomicAdd(&bins[l], atomicLoad(&local[l]));
    atomicAdd(&n, 1u);
}
fn holds() -> bool { return atomicLoad(&bins[0]) + atomicLoad(&bins[1]) == atomicLoad(&n); }
