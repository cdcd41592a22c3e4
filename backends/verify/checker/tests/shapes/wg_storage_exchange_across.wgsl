// entry: main; fragments: 4; sc: race; relaxed: race
// why: The neighbour is in another workgroup, and no barrier orders two workgroups.
// after: gpuweb issue 3774
@group(0) @binding(0) var<storage, read_write> data: array<u32, 4>;
@group(0) @binding(1) var<storage, read_write> seen: array<u32, 4>;
@compute @workgroup_size(2) fn main(@builtin(global_invocation_id) id: vec3u) {
    data[id.x] = id.x + 1u;
    storageBarrier();
    seen[id.x] = data[id.x ^ 2u];
}
