// entry: main; fragments: 2; sc: race; relaxed: race
// why: The first child to arrive computes the parent, while the second may still write its box.
// after: bottom-up refit with the test reversed
@coherent @group(0) @binding(0) var<storage, read_write> box: array<u32, 3>;
@group(0) @binding(1) var<storage, read_write> arrived: atomic<u32>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    box[id.x] = id.x + 4u;
    memory_fence();
    if atomicAdd(&arrived, 1u) == 1u { return; }
    memory_fence();
    box[2] = max(box[0], box[1]);
}
