// entry: main; fragments: 2; fill: bottom=2; sc: holds; relaxed: wrong
// why: Owner stores `bottom` and loads `top`, the thief does the reverse. Without sequentially consistent fences both may miss the other, and one item is taken twice.
// after: Chase and Lev 2005 with acquire-release fences only
@group(0) @binding(0) var<storage, read_write> top: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> bottom: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> taken: array<atomic<u32>, 2>;
fn memory_fence() {}
fn steal() {
    let t = atomicLoad(&top);
    memory_fence();
    let b = atomicLoad(&bottom);
    if t < b { if atomicCompareExchangeWeak(&top, t, t + 1u).exchanged { atomicAdd(&taken[t], 1u); } }
}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 1u { steal(); steal(); return; }
    let b = atomicLoad(&bottom) - 1u;
    atomicStore(&bottom, b);
    memory_fence();
    let t = atomicLoad(&top);
    if t < b { atomicAdd(&taken[b], 1u); return; }
    if t == b { if atomicCompareExchangeWeak(&top, t, t + 1u).exchanged { atomicAdd(&taken[b], 1u); } }
    atomicStore(&bottom, b + 1u);
}
fn holds() -> bool { return atomicLoad(&taken[0]) <= 1u && atomicLoad(&taken[1]) <= 1u; }
