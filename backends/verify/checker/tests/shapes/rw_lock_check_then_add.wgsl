// entry: main; fragments: 2; sc: race; relaxed: race
// why: The reader tests for a writer and then adds itself, and a writer can enter in between.
// after: reader-writer lock with test and addition apart
@group(0) @binding(0) var<storage, read_write> state: atomic<i32>;
@coherent @group(0) @binding(1) var<storage, read_write> pair: array<u32, 2>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        loop { if atomicCompareExchangeWeak(&state, 0, -10).exchanged { break; } }
        memory_fence(); pair[0] = 1u; pair[1] = 1u; memory_fence();
        atomicAdd(&state, 10);
        return;
    }
    loop { if atomicLoad(&state) >= 0 { break; } }
    atomicAdd(&state, 1);
    memory_fence(); seen[id.x] = pair[0] ^ pair[1]; memory_fence();
    atomicSub(&state, 1);
}
