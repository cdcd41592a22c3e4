// entry: main; fragments: 3; sc: deadlock; relaxed: deadlock
// why: Two consumers can both read a count of 1 and both take a position; the second waits for an item that no invocation produces.
// after: cryvosh/queue without the decrement that reserves an item
@group(0) @binding(0) var<storage, read_write> count: atomic<i32>;
@group(0) @binding(1) var<storage, read_write> ends: array<atomic<u32>, 2>;
@group(0) @binding(2) var<storage, read_write> ring: array<atomic<u32>, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        atomicAdd(&count, 1);
        let p = atomicAdd(&ends[1], 1u) % 2u;
        atomicStore(&ring[p], 7u);
        return;
    }
    if atomicLoad(&count) <= 0 { return; }
    atomicSub(&count, 1);
    let p = atomicAdd(&ends[0], 1u) % 2u;
    loop { if atomicExchange(&ring[p], 0u) != 0u { break; } }
}
