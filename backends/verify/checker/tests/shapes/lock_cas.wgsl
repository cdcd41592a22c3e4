// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: A fence after the acquiring exchange and one before the releasing store order the coherent counter. A weak failure only costs another attempt.
// after: per-pixel spin lock (chrismile/LineVis; Bruell 2018)
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
@group(0) @binding(2) var<storage, read_write> n: atomic<u32>;
fn memory_fence() {}
@fragment fn store() {
    atomicAdd(&n, 1u);
    loop { if atomicCompareExchangeWeak(&lock, 0u, 1u).exchanged { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
fn holds() -> bool { return sum == atomicLoad(&n); }
