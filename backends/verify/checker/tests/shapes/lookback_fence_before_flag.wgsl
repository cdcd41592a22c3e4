// entry: scan; fragments: 2,3; sc: holds; relaxed: race
// why: The reader's fence comes before its load of the flag, so nothing orders the load of the sum after the flag.
// after: chained scan with the acquire fence on the wrong side
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> flag: array<atomic<u32>, 4>;
@coherent @group(0) @binding(2) var<storage, read_write> sums: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    var before = 0u;
    if part > 0u {
        loop { memory_fence(); if atomicLoad(&flag[part - 1u]) == 1u { break; } }
        before = sums[part - 1u];
    }
    sums[part] = before + part + 1u;
    memory_fence();
    atomicStore(&flag[part], 1u);
}
fn holds() -> bool { return sums[0] == 1u && sums[1] == 3u; }
