// entry: main; fragments: 2,3; sc: deadlock; relaxed: deadlock
// why: The barrier waits for four arrivals and at most three workgroups run.
// after: grid barrier with a wrong number of workgroups
@group(0) @binding(0) var<storage, read_write> arrived: atomic<u32>;
@compute @workgroup_size(1) fn main() {
    atomicAdd(&arrived, 1u);
    loop { if atomicLoad(&arrived) >= 4u { break; } }
}
