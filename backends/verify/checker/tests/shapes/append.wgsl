// entry: store; fragments: 2,3; sc: holds; relaxed: holds
// why: Positions are unique and those beyond the capacity are not written. The count may exceed the capacity.
// after: append buffer (ria8651/octree-tracer compute.wgsl) and bump allocators, with a bound
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> items: array<u32, 2>;
@fragment fn store() { let at = atomicAdd(&count, 1u); if at < 2u { items[at] = at + 1u; } }
fn holds() -> bool { return items[0] == 1u && items[1] == 2u; }
