// entry: main; fragments: 2; sc: wrong; relaxed: wrong
// why: The loop ends if the old value is the expected one, which a weak exchange may return without a store.
// after: imageAtomicRGBA8Avg (OpenGL Insights 22) ported literally to WGSL
@group(0) @binding(0) var<storage, read_write> voxel: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    var old = 0u;
    loop {
        let now = atomicCompareExchangeWeak(&voxel, old, old + ((id.x + 1u) << 8u) + 1u).old_value;
        if now == old { break; }
        old = now;
    }
}
fn holds() -> bool { return atomicLoad(&voxel) == 0x302u; }
