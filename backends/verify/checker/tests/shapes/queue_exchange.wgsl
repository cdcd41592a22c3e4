// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: A consumer enters only if its decrement of the count finds an item. Slot and value are one atomic word, so no fence is needed.
// after: cuRE index queue (Kenzel et al. 2018); cryvosh/queue
@group(0) @binding(0) var<storage, read_write> count: atomic<i32>;
@group(0) @binding(1) var<storage, read_write> ends: array<atomic<u32>, 2>;
@group(0) @binding(2) var<storage, read_write> ring: array<atomic<u32>, 2>;
@group(0) @binding(3) var<storage, read_write> got: array<u32, 4>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        atomicAdd(&count, 1);
        let p = atomicAdd(&ends[1], 1u) % 2u;
        loop { if atomicCompareExchangeWeak(&ring[p], 0u, 7u).exchanged { break; } }
        return;
    }
    if atomicSub(&count, 1) <= 0 { atomicAdd(&count, 1); return; }
    let p = atomicAdd(&ends[0], 1u) % 2u;
    loop { let v = atomicExchange(&ring[p], 0u); if v != 0u { got[id.x] = v; break; } }
}
fn holds() -> bool { return got[1] + got[2] + atomicLoad(&ring[0]) == 7u && atomicLoad(&count) >= 0; }
