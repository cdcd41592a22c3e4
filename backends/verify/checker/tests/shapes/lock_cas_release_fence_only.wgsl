// entry: store; fragments: 2,3; sc: holds; relaxed: race
// why: Only the release has a fence. The next holder has no acquire fence, so the earlier write does not happen before its read.
// after: chrismile/LineVis, memoryBarrier only before the exchange that unlocks
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicCompareExchangeWeak(&lock, 0u, 1u).exchanged { break; } }
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
