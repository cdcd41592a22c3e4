// entry: main; fragments: 2; sc: holds; relaxed: undecided
// why: The waiting invocation changes another word in each attempt, but a schedule that ends exists from every state. Under relaxed memory the loop has infinitely many histories.
// after: a lock that announces interest while it waits (Dekker)
@group(0) @binding(0) var<storage, read_write> a: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> b: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 1u { atomicStore(&b, 1u); _ = atomicLoad(&a); return; }
    loop { atomicStore(&a, 1u); if atomicLoad(&b) == 1u { break; } atomicStore(&a, 0u); }
}
