// entry: main; fragments: 2,3; sc: holds; relaxed: race
// why: Relaxed atomics order nothing, so the plain write of the node does not happen before the read. Under sc every atomic synchronises.
// after: SteveWolligandt/Yavin linked_list_write.glsl, whose duplicate test walks the list without a barrier
@coherent @group(0) @binding(0) var<storage, read_write> node: u32;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        node = 7u;
        atomicStore(&head, 1u);
    } else if atomicLoad(&head) == 1u {
        seen[id.x] = node;
    }
}
fn holds() -> bool { return seen[1] == 0u || seen[1] == 7u; }
