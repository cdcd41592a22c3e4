// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: The head is published before the node is written, so a reader that observes the head may read the node while it is written.
// after: linked-list writers that fill the node after the exchange of the head, with a concurrent reader
@coherent @group(0) @binding(0) var<storage, read_write> node: u32;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        atomicStore(&head, 1u);
        memory_fence();
        node = 7u;
    } else if atomicLoad(&head) == 1u {
        memory_fence();
        seen[id.x] = node;
    }
}
