// entry: store; fragments: 2,3; fill: head=4294967295; sc: wrong; relaxed: wrong
// why: Load and store of the head are apart, so two fragments can link to the same node and one of them is lost.
// after: per-pixel linked lists (Yang et al. 2010), with the classic lost insertion
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> next: array<u32, 4>;
@fragment fn store() {
    let at = atomicAdd(&count, 1u);
    next[at] = atomicLoad(&head);
    atomicStore(&head, at);
}
fn holds() -> bool {
    var n = 0u;
    var at = atomicLoad(&head);
    while at < 4u && n < 5u { at = next[at]; n++; }
    return n == atomicLoad(&count);
}
