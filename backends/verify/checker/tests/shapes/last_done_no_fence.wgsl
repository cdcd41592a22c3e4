// entry: main; fragments: 2; sc: holds; relaxed: race
// why: A relaxed addition does not order the partial sum of the other workgroup.
// after: last-workgroup reduction without a device fence, the only one that WGSL can express
@coherent @group(0) @binding(0) var<storage, read_write> part: array<u32, 2>;
@group(0) @binding(1) var<storage, read_write> done: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> total: array<u32, 1>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    part[id.x] = id.x + 1u;
    if atomicAdd(&done, 1u) != 1u { return; }
    total[0] = part[0] + part[1];
}
fn holds() -> bool { return total[0] == 3u; }
