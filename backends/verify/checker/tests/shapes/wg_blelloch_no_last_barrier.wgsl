// entry: main; fragments: 2; sc: race; relaxed: race
// why: The results are read without a barrier after the last step, while the other invocation may still write them.
// after: Blelloch scan without the final barrier
@group(0) @binding(0) var<storage, read_write> result: array<u32, 4>;
var<workgroup> s: array<u32, 4>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    s[2u * l] = 1u; s[2u * l + 1u] = 1u;
    var step = 1u;
    for (var d = 2u; d > 0u; d >>= 1u) {
        workgroupBarrier();
        if l < d { s[step * (2u * l + 2u) - 1u] += s[step * (2u * l + 1u) - 1u]; }
        step <<= 1u;
    }
    if l == 0u { s[3] = 0u; }
    for (var d = 1u; d < 4u; d <<= 1u) {
        step >>= 1u;
        workgroupBarrier();
        if l < d { let a = step * (2u * l + 1u) - 1u; let t = s[a]; s[a] = s[a + step]; s[a + step] += t; }
    }
    result[l] = s[l]; result[l + 2u] = s[l + 2u];
}
