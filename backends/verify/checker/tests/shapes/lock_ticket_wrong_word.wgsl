// entry: store; fragments: 2,3; sc: endless; relaxed: endless
// why: The release advances the ticket dispenser instead of the ticket that is served, so the second fragment waits for ever.
// after: ticket lock that releases the wrong word
@group(0) @binding(0) var<storage, read_write> next: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> serving: atomic<u32>;
@coherent @group(0) @binding(2) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    let ticket = atomicAdd(&next, 1u);
    loop { if atomicLoad(&serving) == ticket { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicAdd(&next, 1u);
}
