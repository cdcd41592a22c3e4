// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: storageBarrier orders plain storage accesses within a workgroup, whose scope they have without `@coherent`.
// after: in-place bitonic or FFT steps in a storage buffer
@group(0) @binding(0) var<storage, read_write> data: array<u32, 4>;
@group(0) @binding(1) var<storage, read_write> seen: array<u32, 4>;
@compute @workgroup_size(2) fn main(@builtin(global_invocation_id) id: vec3u) {
    data[id.x] = id.x + 1u;
    storageBarrier();
    seen[id.x] = data[id.x ^ 1u];
}
fn holds() -> bool { return seen[0] == 2u && seen[1] == 1u && (seen[2] == 0u || seen[2] == 4u && seen[3] == 3u); }
