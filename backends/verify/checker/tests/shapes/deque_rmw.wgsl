// entry: main; fragments: 2; fill: bottom=2; sc: holds; relaxed: holds
// why: Owner and thief change `bottom` by read-modify-writes, which are ordered, and fences make the later one observe the other's `top`.
// after: Chase and Lev 2005; Le, Pop, Cohen and Zappa Nardelli 2013, with a read-modify-write in place of the SC fences
@group(0) @binding(0) var<storage, read_write> top: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> bottom: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> taken: array<atomic<u32>, 2>;
fn memory_fence() {}
fn steal() {
    let t = atomicLoad(&top);
    memory_fence();
    let b = atomicAdd(&bottom, 0u);
    if t < b { if atomicCompareExchangeWeak(&top, t, t + 1u).exchanged { atomicAdd(&taken[t], 1u); } }
}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 1u { steal(); steal(); return; }
    let b = atomicSub(&bottom, 1u) - 1u;
    memory_fence();
    let t = atomicLoad(&top);
    if t < b { atomicAdd(&taken[b], 1u); return; }
    if t == b { if atomicCompareExchangeWeak(&top, t, t + 1u).exchanged { atomicAdd(&taken[b], 1u); } }
    atomicStore(&bottom, b + 1u);
}
fn holds() -> bool { return atomicLoad(&taken[0]) <= 1u && atomicLoad(&taken[1]) <= 1u; }
