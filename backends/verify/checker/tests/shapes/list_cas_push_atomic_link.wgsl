// entry: main; fragments: 2,3; sc: holds; relaxed: undecided
// why: As list_cas_push with atomic links: the exchange succeeds only on the link that was stored last. The loop ends if weak failures do. Under relaxed memory the loop has infinitely many histories.
// after: Treiber stack (IBM RJ 5118, 1986)
@group(0) @binding(0) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> next: array<atomic<u32>, 4>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    loop {
        let old = atomicLoad(&head);
        atomicStore(&next[id.x], old);
        if atomicCompareExchangeWeak(&head, old, id.x + 1u).exchanged { break; }
    }
}
fn holds() -> bool {
    var n = 0u;
    var at = atomicLoad(&head);
    while at != 0u && n < 5u { at = atomicLoad(&next[at - 1u]); n++; }
    return n == 2u || n == 3u;
}
