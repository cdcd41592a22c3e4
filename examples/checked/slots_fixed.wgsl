// Four slots for one pixel, allocated by an atomic counter. No two fragments take the same slot.

@group(0) @binding(0) var<storage, read_write> used: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> slots: array<atomic<u32>, 4>;

@fragment
fn store(@builtin(position) position: vec4<f32>) {
    let slot = atomicAdd(&used, 1u);
    if slot < 4u {
        atomicStore(&slots[slot], bitcast<u32>(position.z));
    }
}

/// Returns whether the two fragments took and wrote two slots.
fn holds() -> bool {
    return atomicLoad(&used) == 2u && atomicLoad(&slots[0]) != 0u && atomicLoad(&slots[1]) != 0u;
}
