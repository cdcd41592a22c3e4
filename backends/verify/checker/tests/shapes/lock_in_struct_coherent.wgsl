// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: The variable is coherent, so fences order its plain member too.
// after: lock and data in one coherent structure
struct Cell { lock: atomic<u32>, sum: u32 }
@coherent @group(0) @binding(0) var<storage, read_write> cell: Cell;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicExchange(&cell.lock, 1u) == 0u { break; } }
    memory_fence();
    cell.sum += 1u;
    memory_fence();
    atomicStore(&cell.lock, 0u);
}
fn holds() -> bool { return cell.sum == 2u || cell.sum == 3u; }
