// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: storageBarrier affects the storage address space only; plain workgroup memory is not ordered by it.
// after: WGSL specification, synchronization built-in functions: the wrong barrier
@group(0) @binding(0) var<storage, read_write> sums: array<u32, 2>;
var<workgroup> s: array<u32, 2>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32, @builtin(workgroup_id) w: vec3u) {
    s[l] = l + 1u;
    storageBarrier();
    if l == 0u { sums[w.x] = s[0] + s[1]; }
}
