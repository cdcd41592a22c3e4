// entry: store; fragments: 2,3; sc: deadlock; relaxed: deadlock
// why: After discard a fragment is a helper invocation, whose writes have no effect, so it never releases the lock that it holds.
// after: alpha test inside of a per-pixel critical section
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store(@builtin(position) p: vec4f) {
    loop { if atomicExchange(&lock, 1u) == 0u { break; } }
    memory_fence();
    if p.z < 0.2 { discard; }
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
