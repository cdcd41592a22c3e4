// entry: store; fragments: 2,3; fill: head=4294967295; sc: wrong; relaxed: wrong
// why: The loop compares the old value and ignores `exchanged`. A weak exchange may fail although the old value is the expected one; then the node is never linked.
// after: Treiber stack, ported from GLSL's atomicCompSwap, which is strong
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> next: array<u32, 4>;
@fragment fn store() {
    let at = atomicAdd(&count, 1u);
    loop {
        let old = atomicLoad(&head);
        next[at] = old;
        if atomicCompareExchangeWeak(&head, old, at).old_value == old { break; }
    }
}
fn holds() -> bool {
    var n = 0u;
    var at = atomicLoad(&head);
    while at < 4u && n < 5u { at = next[at]; n++; }
    return n == atomicLoad(&count);
}
