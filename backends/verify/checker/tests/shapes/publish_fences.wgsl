// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The node is written before the writer's fence and read after the reader's fence, and the reader reads it only if it has observed the head.
// after: publication of a list node to concurrent readers (duplicate test of SteveWolligandt/Yavin linked_list_write.glsl)
@coherent @group(0) @binding(0) var<storage, read_write> node: u32;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        node = 7u;
        memory_fence();
        atomicStore(&head, 1u);
    } else if atomicLoad(&head) == 1u {
        memory_fence();
        seen[id.x] = node;
    }
}
fn holds() -> bool { return (seen[1] == 0u || seen[1] == 7u) && (seen[2] == 0u || seen[2] == 7u); }
