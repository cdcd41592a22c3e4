// entry: store; fragments: 2; sc: wrong; relaxed: wrong
// why: A fragment ends after eight attempts, although the lock is released later. Loops below 32 attempts are followed exactly.
// after: spin locks with a bound against GPU hangs
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    for (var i = 0; i < 8; i++) {
        if atomicExchange(&lock, 1u) == 0u {
            memory_fence();
            sum += 1u;
            memory_fence();
            atomicStore(&lock, 0u);
            return;
        }
    }
}
fn holds() -> bool { return sum == 2u; }
