// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: The fragment is discarded before it takes the lock.
// after: alpha test before a per-pixel critical section
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store(@builtin(position) p: vec4f) {
    if p.z < 0.2 { discard; }
    loop { if atomicExchange(&lock, 1u) == 0u { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
fn holds() -> bool { return sum == 1u || sum == 2u; }
