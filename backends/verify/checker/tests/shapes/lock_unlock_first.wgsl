// entry: store; fragments: 2,3; sc: race; relaxed: race
// why: The lock is released before the counter is written, so the next holder accesses it concurrently.
// after: spin lock with the wrong order of release
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicExchange(&lock, 1u) == 0u { break; } }
    memory_fence();
    let next = sum + 1u;
    atomicStore(&lock, 0u);
    memory_fence();
    sum = next;
}
