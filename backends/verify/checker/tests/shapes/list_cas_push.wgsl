// entry: store; fragments: 2,3; fill: head=4294967295; sc: holds; relaxed: holds
// why: The exchange succeeds only if the head still is the link that was stored. Indices are never reused, so there is no ABA.
// after: Treiber stack (IBM RJ 5118, 1986)
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> next: array<u32, 4>;
@fragment fn store() {
    let at = atomicAdd(&count, 1u);
    loop {
        let old = atomicLoad(&head);
        next[at] = old;
        if atomicCompareExchangeWeak(&head, old, at).exchanged { break; }
    }
}
fn holds() -> bool {
    var n = 0u;
    var at = atomicLoad(&head);
    while at < 4u && n < 5u { at = next[at]; n++; }
    return n == atomicLoad(&count);
}
