// entry: store; fragments: 3; sc: race; relaxed: race
// why: The third invocation writes beyond the two items. WGSL keeps it inside of the buffer, but the item lands elsewhere or nowhere.
// after: append buffer without a bound
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> items: array<u32, 2>;
@fragment fn store() { let at = atomicAdd(&count, 1u); items[at] = at + 1u; }
