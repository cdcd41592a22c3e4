// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: workgroupBarrier affects the workgroup address space only; plain storage accesses are not ordered by it.
// after: WGSL specification, synchronization built-in functions: the wrong barrier
@group(0) @binding(0) var<storage, read_write> data: array<u32, 4>;
@group(0) @binding(1) var<storage, read_write> seen: array<u32, 4>;
@compute @workgroup_size(2) fn main(@builtin(global_invocation_id) id: vec3u) {
    data[id.x] = id.x + 1u;
    workgroupBarrier();
    seen[id.x] = data[id.x ^ 1u];
}
