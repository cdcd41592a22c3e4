// entry: main; fragments: 2; sc: barrier; relaxed: barrier
// why: Invocation 1 waits at a barrier that invocation 0, after its return, never reaches. Browsers reject the shader (uniformity analysis); Vulkan leaves it undefined.
// after: early return before a barrier
@group(0) @binding(0) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) l: u32) {
    if l == 0u { return; }
    workgroupBarrier();
    atomicAdd(&n, 1u);
}
