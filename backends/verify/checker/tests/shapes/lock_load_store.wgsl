// entry: store; fragments: 2,3; sc: race; relaxed: race
// why: Test and set are two operations, so two fragments can enter and access the counter concurrently.
// after: spin lock with a load and a store instead of an exchange
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicLoad(&lock) == 0u { atomicStore(&lock, 1u); break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
