// entry: main; fragments: 2; sc: holds; relaxed: wrong
// why: Without a fence between the data and the second load of the number, that load may be older than the data, so a torn pair is accepted.
// after: sequence lock whose reader has an acquire on the first load only (jeongminpark417/COALA-GNN seqlock.h)
@group(0) @binding(0) var<storage, read_write> seq: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> a: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> b: atomic<u32>;
@group(0) @binding(3) var<storage, read_write> seen: array<vec2u, 4>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        atomicStore(&seq, 1u); memory_fence();
        atomicStore(&a, 9u); atomicStore(&b, 9u);
        memory_fence(); atomicStore(&seq, 2u);
    } else {
        let first = atomicLoad(&seq); memory_fence();
        let pair = vec2u(atomicLoad(&a), atomicLoad(&b));
        if atomicLoad(&seq) == first && (first & 1u) == 0u { seen[id.x] = pair; }
    }
}
fn holds() -> bool { return seen[1].x == seen[1].y; }
