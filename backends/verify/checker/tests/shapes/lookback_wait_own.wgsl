// entry: scan; fragments: 2,3; sc: deadlock; relaxed: deadlock
// why: A part waits for its own flag, which it sets only after the wait.
// after: chained scan with an index that is off by one
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> flag: array<atomic<u32>, 4>;
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    if part > 0u { loop { if atomicLoad(&flag[part]) == 1u { break; } } }
    atomicStore(&flag[part], 1u);
}
