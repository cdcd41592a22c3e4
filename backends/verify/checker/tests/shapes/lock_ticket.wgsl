// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: Tickets are unique, each is served after the one before, and fences surround the critical section.
// after: ticket lock (Mellor-Crummey and Scott 1991; Dat3M ticketlock)
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
    atomicStore(&serving, ticket + 1u);
}
fn holds() -> bool { return sum == atomicLoad(&next); }
