// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The slot's number tells whether its item is written. Fences separate item and number on both sides; only one consumer takes a position.
// after: Vyukov bounded MPMC queue; plasius/gpu-lock-free-queue
@group(0) @binding(0) var<storage, read_write> tail: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seq: array<atomic<u32>, 2>;
@coherent @group(0) @binding(3) var<storage, read_write> item: array<u32, 2>;
@group(0) @binding(4) var<storage, read_write> got: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x != 1u {
        let at = atomicAdd(&tail, 1u);
        item[at] = id.x + 5u;
        memory_fence();
        atomicStore(&seq[at], at + 1u);
    } else if atomicLoad(&seq[0]) == 1u && atomicCompareExchangeWeak(&head, 0u, 1u).exchanged {
        memory_fence();
        got[0] = item[0];
    }
}
fn holds() -> bool { return atomicLoad(&head) == 0u || got[0] == item[0] && got[0] >= 5u; }
