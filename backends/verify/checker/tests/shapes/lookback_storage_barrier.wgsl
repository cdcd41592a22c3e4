// entry: scan; fragments: 2,3; sc: holds; relaxed: race
// why: storageBarrier has workgroup scope, and each part is a workgroup, so the sum of another workgroup is not ordered.
// after: gpuweb issue 3774 (memory accesses across workgroups); raphlinus.github.io, prefix sum portable
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> flag: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> sums: array<u32, 4>;
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    var before = 0u;
    loop { if part == 0u || atomicLoad(&flag[max(part, 1u) - 1u]) == 1u { break; } }
    storageBarrier();
    if part > 0u { before = sums[part - 1u]; }
    sums[part] = before + part + 1u;
    storageBarrier();
    atomicStore(&flag[part], 1u);
}
fn holds() -> bool { return sums[0] == 1u && sums[1] == 3u; }
