// entry: main; fragments: 2,3; sc: holds; relaxed: holds
// why: If a reader observes a word of the write, its fence makes it observe the odd number as well; if it observes 2 first, it observes both words.
// after: Boehm, Can seqlocks get along with programming language memory models (MSPC 2012); HeteroSync SeqLock
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
        memory_fence();
        if atomicLoad(&seq) == first && (first & 1u) == 0u { seen[id.x] = pair; }
    }
}
fn holds() -> bool { return seen[1].x == seen[1].y && seen[2].x == seen[2].y; }
