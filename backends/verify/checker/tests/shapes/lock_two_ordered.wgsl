// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Every invocation takes lock 0 before lock 1, so no cycle of waits exists, and fences order the coherent counter.
// after: lock hierarchy (Havender 1968), two cells of a cloth or particle grid
@group(0) @binding(0) var<storage, read_write> lock: array<atomic<u32>, 2>;
@coherent @group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@compute @workgroup_size(1) fn main() {
    loop { if atomicExchange(&lock[0], 1u) == 0u { break; } }
    loop { if atomicExchange(&lock[1], 1u) == 0u { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock[1], 0u);
    atomicStore(&lock[0], 0u);
}
fn holds() -> bool { return sum == 2u || sum == 3u; }
