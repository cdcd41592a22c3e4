// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The sum changes only if it still is the value that was added to. All values are small integers, so the sum is exact.
// after: atomic addition of floats by compare-and-swap (taichi, CUDA programming guide)
@group(0) @binding(0) var<storage, read_write> sum: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(1) fn main() {
    atomicAdd(&n, 1u);
    loop {
        let old = atomicLoad(&sum);
        if atomicCompareExchangeWeak(&sum, old, bitcast<u32>(bitcast<f32>(old) + 1.0)).exchanged { break; }
    }
}
fn holds() -> bool { return bitcast<f32>(atomicLoad(&sum)) == f32(atomicLoad(&n)); }
