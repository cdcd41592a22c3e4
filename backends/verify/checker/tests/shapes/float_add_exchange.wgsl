// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: Each invocation takes the sum out, adds and puts it back; what it finds while it puts back it adds again. Nothing is lost by exchanges.
// after: Futhark atomics.wgsl (addition by two exchanges)
@group(0) @binding(0) var<storage, read_write> sum: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(1) fn main() {
    atomicAdd(&n, 1u);
    var rest = 1.0;
    loop {
        let whole = bitcast<f32>(atomicExchange(&sum, 0u)) + rest;
        rest = bitcast<f32>(atomicExchange(&sum, bitcast<u32>(whole)));
        if rest == 0.0 { break; }
    }
}
fn holds() -> bool { return bitcast<f32>(atomicLoad(&sum)) == f32(atomicLoad(&n)); }
