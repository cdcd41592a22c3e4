// entry: main; fragments: 2; sc: wrong; relaxed: wrong
// why: The key is visible before its value, so a concurrent look-up finds the key with the value 0.
// after: SJTU-IPADS/gnnlab hash_map.cu (value stored after the exchange of the key)
@group(0) @binding(0) var<storage, read_write> key: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> value: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 2>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        atomicExchange(&key, 9u);
        memory_fence();
        atomicStore(&value, 5u);
    } else if atomicLoad(&key) == 9u {
        memory_fence();
        seen[0] = 1u;
        seen[1] = atomicLoad(&value);
    }
}
fn holds() -> bool { return seen[0] == 0u || seen[1] == 5u; }
