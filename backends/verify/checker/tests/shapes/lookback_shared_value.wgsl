// entry: scan; fragments: 3; sc: wrong; relaxed: wrong
// why: Aggregate and inclusive sum share one slot with a separate flag. A part that reads flag 1 and then the inclusive sum adds the earlier parts twice.
// after: decoupled look-back with one value slot for both states
@group(0) @binding(0) var<storage, read_write> ticket: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> flag: array<atomic<u32>, 4>;
@group(0) @binding(2) var<storage, read_write> value: array<atomic<u32>, 4>;
@group(0) @binding(3) var<storage, read_write> result: array<u32, 4>;
@compute @workgroup_size(1) fn scan() {
    let part = atomicAdd(&ticket, 1u);
    let own = part + 1u;
    var before = 0u;
    if part > 0u { atomicStore(&value[part], own); atomicStore(&flag[part], 1u); }
    var at = part;
    while at > 0u {
        let f = atomicLoad(&flag[at - 1u]);
        if f != 0u { before += atomicLoad(&value[at - 1u]); at -= 1u; }
        if f == 2u { break; }
    }
    atomicStore(&value[part], before + own);
    atomicStore(&flag[part], 2u);
    result[part] = before;
}
fn holds() -> bool { return result[0] == 0u && result[1] == 1u && result[2] == 3u; }
