// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Sum and number of samples share one word, which a compare-exchange replaces as a whole.
// after: Crassin and Green, sparse voxelization (OpenGL Insights 22)
@group(0) @binding(0) var<storage, read_write> voxel: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    var old = 0u;
    loop {
        let r = atomicCompareExchangeWeak(&voxel, old, old + ((id.x + 1u) << 8u) + 1u);
        if r.exchanged { break; }
        old = r.old_value;
    }
}
fn holds() -> bool { let v = atomicLoad(&voxel); return v == 0x302u || v == 0x603u; }
