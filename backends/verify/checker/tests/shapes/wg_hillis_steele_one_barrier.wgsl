// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: Invocation 0 writes its element while invocation 1 may still read it; nothing orders the two plain accesses.
// after: Hillis-Steele scan in place with one barrier per step
@group(0) @binding(0) var<storage, read_write> result: array<u32, 4>;
var<workgroup> s: array<u32, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(global_invocation_id) id: vec3u) {
    s[l] = l + 1u;
    workgroupBarrier();
    var v = s[l];
    if l >= 1u { v += s[l - 1u]; }
    s[l] = v;
    workgroupBarrier();
    result[id.x] = s[l];
}
