// entry: main; fragments: 2,3; sc: deadlock; relaxed: deadlock
// why: Even invocations take lock 0 first and odd ones lock 1, so each can hold the lock that the other waits for.
// after: lock per particle of a constraint, taken in the order of the constraint
@group(0) @binding(0) var<storage, read_write> lock: array<atomic<u32>, 2>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let a = id.x & 1u;
    loop { if atomicExchange(&lock[a], 1u) == 0u { break; } }
    loop { if atomicExchange(&lock[1u - a], 1u) == 0u { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock[1u - a], 0u);
    atomicStore(&lock[a], 0u);
}
