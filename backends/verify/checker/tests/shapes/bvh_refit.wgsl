// entry: main; fragments: 2; sc: holds; relaxed: holds
// why: The second child to arrive computes the parent; fences before and after the addition order the box of the first.
// after: Karras 2012; NVIDIA/warp bvh.cu (with an acquire fence added)
@coherent @group(0) @binding(0) var<storage, read_write> box: array<u32, 3>;
@group(0) @binding(1) var<storage, read_write> arrived: atomic<u32>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    box[id.x] = id.x + 4u;
    memory_fence();
    if atomicAdd(&arrived, 1u) == 0u { return; }
    memory_fence();
    box[2] = max(box[0], box[1]);
}
fn holds() -> bool { return box[2] == 5u; }
