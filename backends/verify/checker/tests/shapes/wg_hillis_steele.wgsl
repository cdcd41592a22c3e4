// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Barriers separate the reads of a step from its writes and from the writes before.
// after: Hillis and Steele 1986; ArthurBrussee/brush prefix_sum_helpers.wgsl
@group(0) @binding(0) var<storage, read_write> result: array<u32, 4>;
var<workgroup> s: array<u32, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(global_invocation_id) id: vec3u) {
    s[l] = l + 1u;
    workgroupBarrier();
    var v = s[l];
    if l >= 1u { v += s[l - 1u]; }
    workgroupBarrier();
    s[l] = v;
    result[id.x] = s[l];
}
fn holds() -> bool { return result[0] == 1u && result[1] == 3u && (result[2] == 0u || result[2] == 1u && result[3] == 3u); }
