// entry: main; fragments: 2; sc: holds; relaxed: race
// why: The lock is in workgroup memory and has no fence; relaxed atomics do not order the plain counter.
// after: suguruwataru/wgsl-loop loop.wgsl
@group(0) @binding(0) var<storage, read_write> sum: u32;
var<workgroup> lock: atomic<u32>;
@compute @workgroup_size(2) fn main() {
    loop { if atomicOr(&lock, 1u) == 0u { break; } }
    sum += 1u;
    atomicAnd(&lock, 0u);
}
fn holds() -> bool { return sum == 2u; }
