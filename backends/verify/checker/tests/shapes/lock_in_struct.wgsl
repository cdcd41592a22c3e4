// entry: store; fragments: 2,3; sc: holds; relaxed: race
// why: As lock_not_coherent. An atomic member in the same structure does not change the scope of plain accesses of another member.
// after: lock and data in one structure, as in many SSBO layouts
struct Cell { lock: atomic<u32>, sum: u32 }
@group(0) @binding(0) var<storage, read_write> cell: Cell;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicExchange(&cell.lock, 1u) == 0u { break; } }
    memory_fence();
    cell.sum += 1u;
    memory_fence();
    atomicStore(&cell.lock, 0u);
}
