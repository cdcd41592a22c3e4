// entry: scan; fragments: 2,3; sc: holds; relaxed: holds
// why: The sum is stored before a fence and the flag after it; the reader loads the flag, fences, and then loads the sum.
// after: chained scan (Yan, Long and Zhang, StreamScan 2013); linebender/vello, prefix sum notes of Raph Levien
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> flag: array<atomic<u32>, 4>;
@coherent @group(0) @binding(2) var<storage, read_write> sums: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    var before = 0u;
    if part > 0u {
        loop { if atomicLoad(&flag[part - 1u]) == 1u { break; } }
        memory_fence();
        before = sums[part - 1u];
    }
    sums[part] = before + part + 1u;
    memory_fence();
    atomicStore(&flag[part], 1u);
}
fn holds() -> bool { return sums[0] == 1u && sums[1] == 3u && (sums[2] == 0u || sums[2] == 6u); }
