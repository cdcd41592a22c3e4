// entry: draw; fragments: 2,3; sc: wrong; relaxed: wrong
// why: A fragment that was the nearest at its atomicMax stores its identity after a nearer fragment has stored its own.
// after: matteokeole/3d_playground visibility.frag.wgsl (depth and identity in two buffers)
@group(0) @binding(0) var<storage, read_write> depth: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> identity: atomic<u32>;
@fragment fn draw(@builtin(position) p: vec4f) {
    let own = u32(p.z * 8.0);
    if atomicMax(&depth, own) < own { atomicStore(&identity, own + 40u); }
}
fn holds() -> bool { return atomicLoad(&identity) == atomicLoad(&depth) + 40u; }
