// entry: store; fragments: 2,3; fill: head=4294967295; sc: holds; relaxed: holds
// why: The counter and the head change by read-modify-writes only, so indices are unique and the exchanges form one chain. No fragment reads a link of another.
// after: per-pixel linked lists (Yang, Hensley, Gruen and Thibieroz 2010); webgpu-samples A-buffer
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> head: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> next: array<u32, 4>;
@fragment fn store() { let at = atomicAdd(&count, 1u); next[at] = atomicExchange(&head, at); }
fn holds() -> bool {
    var n = 0u;
    var at = atomicLoad(&head);
    while at < 4u && n < 5u { at = next[at]; n++; }
    return n == atomicLoad(&count) && at == 0xffffffffu;
}
