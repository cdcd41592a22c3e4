// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: The number of the slot is stored before its item, so a consumer reads the item while it is written.
// after: Vyukov bounded MPMC queue that publishes before it writes
@group(0) @binding(0) var<storage, read_write> tail: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> seq: array<atomic<u32>, 2>;
@coherent @group(0) @binding(2) var<storage, read_write> item: array<u32, 2>;
@group(0) @binding(3) var<storage, read_write> got: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x != 1u {
        let at = atomicAdd(&tail, 1u);
        atomicStore(&seq[at], at + 1u);
        memory_fence();
        item[at] = id.x + 5u;
    } else if atomicLoad(&seq[0]) == 1u {
        memory_fence();
        got[0] = item[0];
    }
}
