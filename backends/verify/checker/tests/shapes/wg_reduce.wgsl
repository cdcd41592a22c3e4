// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The barrier orders the writes of both invocations before the sum of the first.
// after: tree reduction (Harris, Optimizing parallel reduction in CUDA)
@group(0) @binding(0) var<storage, read_write> sums: array<u32, 2>;
var<workgroup> s: array<u32, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(workgroup_id) w: vec3u) {
    s[l] = l + 1u;
    workgroupBarrier();
    if l == 0u { sums[w.x] = s[0] + s[1]; }
}
fn holds() -> bool { return sums[0] == 3u && (sums[1] == 0u || sums[1] == 3u); }
