// entry: main; fragments: 2,3; sc: race; relaxed: race
// why: The others wait for any value but 0, which means started, not finished, and read the table while it is written.
// after: call-once initialisation that confuses started and finished
@group(0) @binding(0) var<storage, read_write> state: atomic<u32>;
@coherent @group(0) @binding(1) var<storage, read_write> table: u32;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if atomicMax(&state, 1u) == 0u {
        table = 5u;
        memory_fence();
        atomicStore(&state, 2u);
    } else {
        loop { if atomicLoad(&state) != 0u { break; } }
        memory_fence();
    }
    seen[id.x] = table;
}
