// Computes prefix sums inside one workgroup of 256 invocations (Hillis & Steele 1986).

var<workgroup> sums: array<u32, 256>;

/// Returns the sum of `value` over this invocation and all before it. Afterwards `sums[255]` is the sum over all,
/// until the next call. Every invocation of the workgroup must call it.
fn workgroup_scan(local: u32, value: u32) -> u32 {
    workgroupBarrier();
    sums[local] = value;
    workgroupBarrier();
    for (var distance = 1u; distance < 256u; distance *= 2u) {
        var before = 0u;
        if local >= distance {
            before = sums[local - distance];
        }
        workgroupBarrier();
        sums[local] += before;
        workgroupBarrier();
    }
    return sums[local];
}
