// entry: main; fragments: 2; fill: next=1,2,3,4; sc: wrong; relaxed: wrong
// why: One invocation reads head 0 and link 1; the other takes 0 and 1 and returns 0. The exchange still succeeds, and node 1 is in use and free at once (ABA).
// after: Treiber stack without a tag
@group(0) @binding(0) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> next: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> owner: array<atomic<u32>, 4>;
fn memory_fence() {}
fn pop() -> u32 {
    var h = 0u;
    loop {
        h = atomicLoad(&head);
        memory_fence();
        let n = atomicLoad(&next[h]);
        if atomicCompareExchangeWeak(&head, h, n).exchanged { break; }
    }
    return h;
}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u { atomicAdd(&owner[pop()], 1u); return; }
    let a = pop(); let b = pop();
    atomicAdd(&owner[b], 1u);
    let h = atomicLoad(&head);
    atomicStore(&next[a], h);
    memory_fence(); atomicCompareExchangeWeak(&head, h, a);
}
fn holds() -> bool {
    return atomicLoad(&owner[atomicLoad(&head) & 7u]) == 0u;
}
