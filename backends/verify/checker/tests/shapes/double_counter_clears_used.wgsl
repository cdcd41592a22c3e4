// entry: main; fragments: 2,3; fill: counts=7; sc: wrong; relaxed: wrong
// why: Invocation 0 clears the counter to which others may have added already; nothing makes them wait.
// after: counter that the dispatch that uses it clears
@group(0) @binding(0) var<storage, read_write> counts: array<atomic<u32>, 2>;
@group(0) @binding(1) var<storage, read_write> n: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u { atomicStore(&counts[0], 0u); }
    atomicAdd(&n, 1u);
    atomicAdd(&counts[0], 1u);
}
fn holds() -> bool { return atomicLoad(&counts[0]) == atomicLoad(&n); }
