// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The table is written before a fence and the flag; an invocation that observes the flag fences before the read. The lock orders the slow path.
// after: double-checked locking (Schmidt and Harrison 1996)
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> ready: atomic<u32>;
@coherent @group(0) @binding(2) var<storage, read_write> table: u32;
@group(0) @binding(3) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if atomicLoad(&ready) == 0u {
        loop { if atomicExchange(&lock, 1u) == 0u { break; } }
        memory_fence();
        if atomicLoad(&ready) == 0u { table = 5u; memory_fence(); atomicStore(&ready, 1u); }
        memory_fence();
        atomicStore(&lock, 0u);
    }
    memory_fence();
    seen[id.x] = table;
}
fn holds() -> bool { return seen[0] == 5u && seen[1] == 5u; }
