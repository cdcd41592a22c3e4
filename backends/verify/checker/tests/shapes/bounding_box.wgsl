// entry: main; fragments: 2,3; fill: box=4294967295,0; sc: holds; relaxed: holds
// why: Minimum and maximum are read-modify-writes of independent words, which the host has set before.
// after: scene bounds for LBVH (Karras 2012)
@group(0) @binding(0) var<storage, read_write> box: array<atomic<u32>, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    atomicMin(&box[0], id.x + 5u);
    atomicMax(&box[1], id.x + 5u);
}
fn holds() -> bool { return atomicLoad(&box[0]) == 5u && atomicLoad(&box[1]) >= 6u; }
