// entry: main; fragments: 2; sc: holds; relaxed: race
// why: An invocation that observes the flag at the first load reads the table without a fence.
// after: double-checked locking, the classic bug
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
    seen[id.x] = table;
}
