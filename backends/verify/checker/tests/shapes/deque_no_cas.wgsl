// entry: main; fragments: 2; fill: bottom=1; sc: wrong; relaxed: wrong
// why: The owner takes the last item without an exchange of `top`, so the thief, which has read `bottom` before, takes it as well.
// after: Chase and Lev 2005 without the exchange for the last item
@group(0) @binding(0) var<storage, read_write> top: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> bottom: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> taken: array<atomic<u32>, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 1u {
        let t = atomicLoad(&top);
        if t < atomicLoad(&bottom) { if atomicCompareExchangeWeak(&top, t, t + 1u).exchanged { atomicAdd(&taken[t], 1u); } }
        return;
    }
    let b = atomicSub(&bottom, 1u) - 1u;
    if atomicLoad(&top) <= b { atomicAdd(&taken[b], 1u); }
}
fn holds() -> bool { return atomicLoad(&taken[0]) <= 1u; }
