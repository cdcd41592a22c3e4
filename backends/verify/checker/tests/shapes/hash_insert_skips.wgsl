// entry: main; fragments: 2; sc: wrong; relaxed: wrong
// why: After a weak exchange that fails for no reason the slot is still empty, but the probe moves on, so one key gets two slots.
// after: wilson-anysphere/formula groupby_count.wgsl
@group(0) @binding(0) var<storage, read_write> keys: array<atomic<u32>, 4>;
@group(0) @binding(1) var<storage, read_write> counts: array<atomic<u32>, 4>;
@compute @workgroup_size(1) fn main() {
    var slot = 1u;
    loop {
        let r = atomicCompareExchangeWeak(&keys[slot], 0u, 9u);
        if r.exchanged || r.old_value == 9u { break; }
        slot = (slot + 1u) & 3u;
    }
    atomicAdd(&counts[slot], 1u);
}
fn holds() -> bool { return atomicLoad(&counts[1]) == 2u; }
