// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: The winner of the exchange writes the table, fences and stores 2; the others wait for 2 and fence before they read it.
// after: call-once initialisation, virtual texture page tables
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
        loop { if atomicLoad(&state) == 2u { break; } }
        memory_fence();
    }
    seen[id.x] = table;
}
fn holds() -> bool { return seen[0] == 5u && seen[1] == 5u && (seen[2] == 5u || seen[2] == 0u); }
