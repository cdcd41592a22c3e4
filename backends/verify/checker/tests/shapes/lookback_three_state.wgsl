// entry: scan; fragments: 2,3; sc: holds; relaxed: holds
// why: State and value share one word, so each load is consistent by itself, and a stale load only costs another look.
// after: Merrill and Garland, decoupled look-back (NVIDIA 2016); b0nes164/GPUPrefixSums
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> parts: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> result: array<u32, 4>;
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    let own = part + 1u;
    if part > 0u { atomicStore(&parts[part], (own << 2u) | 1u); }
    var before = 0u;
    var at = part;
    while at > 0u {
        let s = atomicLoad(&parts[at - 1u]);
        if (s & 3u) != 0u { before += s >> 2u; at -= 1u; }
        if (s & 3u) == 2u { break; }
    }
    atomicStore(&parts[part], ((before + own) << 2u) | 2u);
    result[part] = before;
}
fn holds() -> bool {
    var sum = 0u;
    for (var i = 0u; i < atomicLoad(&ticket); i++) { if result[i] != sum { return false; } sum += i + 1u; }
    return true;
}
