// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: Invocation 0 reads the element of invocation 1 without a barrier.
// after: warp-synchronous reduction (Harris), which relied on lockstep execution
@group(0) @binding(0) var<storage, read_write> sums: array<u32, 2>;
var<workgroup> s: array<u32, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(workgroup_id) w: vec3u) {
    s[l] = l + 1u;
    if l == 0u { sums[w.x] = s[0] + s[1]; }
}
