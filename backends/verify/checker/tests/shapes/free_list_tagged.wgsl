// entry: main; fragments: 2; fill: next=1,2,3,4; sc: holds; relaxed: holds
// why: The head carries a tag that each change increases, so an exchange succeeds only if nothing has changed. Fences order links and head.
// after: tagged Treiber stack (IBM System/370); particle dead lists
@group(0) @binding(0) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> next: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> owner: array<atomic<u32>, 4>;
fn memory_fence() {}
fn pop() -> u32 {
    var h = 0u;
    loop {
        h = atomicLoad(&head);
        memory_fence();
        let n = atomicLoad(&next[h & 7u]);
        if atomicCompareExchangeWeak(&head, h, (h & ~7u) + 8u + n).exchanged { break; }
    }
    return h & 7u;
}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u { atomicAdd(&owner[pop()], 1u); return; }
    let a = pop(); let b = pop();
    atomicAdd(&owner[b], 1u);
    let h = atomicLoad(&head);
    atomicStore(&next[a], h & 7u);
    memory_fence(); atomicCompareExchangeWeak(&head, h, (h & ~7u) + 8u + a);
}
fn holds() -> bool {
    return atomicLoad(&owner[atomicLoad(&head) & 7u]) == 0u;
}
