// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: The load is only a hint; the exchange decides, and fences follow and precede the critical section.
// after: test-and-test-and-set lock (Rudolph and Segall 1984; Dat3M ttaslock)
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicLoad(&lock) == 0u { if atomicExchange(&lock, 1u) == 0u { break; } } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
fn holds() -> bool { return sum == 2u || sum == 3u; }
