// entry: main; fragments: 2; sc: wrong; relaxed: wrong
// why: The loop ends if the old value is the expected one. A weak exchange that fails for no reason returns just that and adds nothing.
// after: GLSL polyfills with atomicCompSwap (taichi atomics_gtmp_f32.glsl.h) ported to WGSL
@group(0) @binding(0) var<storage, read_write> sum: atomic<u32>;
@compute @workgroup_size(1) fn main() {
    loop {
        let old = atomicLoad(&sum);
        let new_ = bitcast<u32>(bitcast<f32>(old) + 1.0);
        if atomicCompareExchangeWeak(&sum, old, new_).old_value == old { break; }
    }
}
fn holds() -> bool { return bitcast<f32>(atomicLoad(&sum)) == 2.0; }
