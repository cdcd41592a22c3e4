// entry: store; fragments: 2,3; sc: holds; relaxed: race
// why: A plain storage access of WGSL is made available and visible at workgroup scope only, so a device fence does not order it between fragments.
// after: spin lock around plain data without `coherent`; WGSL memory model, private versus non-private
@group(0) @binding(0) var<storage, read_write> lock: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> sum: u32;
fn memory_fence() {}
@fragment fn store() {
    loop { if atomicExchange(&lock, 1u) == 0u { break; } }
    memory_fence();
    sum += 1u;
    memory_fence();
    atomicStore(&lock, 0u);
}
