// entry: main; fragments: 2; sc: holds; relaxed: undecided
// why: An invocation that cannot take the second lock releases the first. An endless contest needs an unfair schedule for ever, and from each state some schedule ends. Under relaxed memory the loop has infinitely many histories.
// after: try-lock with back-off for two locks
@group(0) @binding(0) var<storage, read_write> lock: array<atomic<u32>, 2>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let a = id.x & 1u;
    loop {
        loop { if atomicExchange(&lock[a], 1u) == 0u { break; } }
        if atomicExchange(&lock[1u - a], 1u) == 0u { break; }
        atomicStore(&lock[a], 0u);
    }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock[1u - a], 0u);
    atomicStore(&lock[a], 0u);
}
fn holds() -> bool { return sum == 2u; }
