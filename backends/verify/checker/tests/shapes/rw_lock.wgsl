// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: A reader enters by an exchange from a state without a writer, the writer only from 0; fences surround both sections.
// after: reader-writer lock in one word (Mellor-Crummey and Scott 1991)
@group(0) @binding(0) var<storage, read_write> state: atomic<i32>;
@coherent @group(0) @binding(1) var<storage, read_write> pair: array<u32, 2>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        loop { if atomicCompareExchangeWeak(&state, 0, -1).exchanged { break; } }
        memory_fence(); pair[0] = 1u; pair[1] = 1u; memory_fence();
        atomicStore(&state, 0);
        return;
    }
    loop {
        let s = max(atomicLoad(&state), 0);
        if atomicCompareExchangeWeak(&state, s, s + 1).exchanged { break; }
    }
    memory_fence(); seen[id.x] = pair[0] ^ pair[1]; memory_fence();
    atomicSub(&state, 1);
}
fn holds() -> bool { return seen[1] == 0u && seen[2] == 0u; }
