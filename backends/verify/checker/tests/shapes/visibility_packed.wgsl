// entry: draw; fragments: 2,3; sc: holds; relaxed: holds
// why: Depth is in the upper and identity in the lower half of one word, so atomicMax keeps a pair of one fragment.
// after: Nanite visibility buffer (Karis 2021), 64 bits emulated in 32
@group(0) @binding(0) var<storage, read_write> texel: atomic<u32>;
@fragment fn draw(@builtin(position) p: vec4f) {
    let depth = u32(p.z * 8.0);
    atomicMax(&texel, (depth << 16u) | (depth + 40u));
}
fn holds() -> bool { let t = atomicLoad(&texel); return (t & 0xffffu) == (t >> 16u) + 40u && (t >> 16u) >= 2u; }
