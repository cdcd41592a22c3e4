struct Header {
    count: atomic<u32>,
    lowest: atomic<i32>,
    items: array<atomic<u32>>,
}
struct Totals {
    used: atomic<u32>,
    lost: u32,
}
@group(0) @binding(0) var<storage, read_write> header: Header;
@group(0) @binding(1) var<storage, read_write> totals: Totals;
@group(0) @binding(2) var<storage, read_write> words: array<atomic<u32>>;
@group(1) @binding(2) var<storage, read_write> result: array<u32>;
var<workgroup> shared_count: atomic<u32>;
var<workgroup> scratch: array<u32, 64>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) i: u32, @builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    atomicStore(&shared_count, 0u);
    scratch[i] = i + local.y;
    workgroupBarrier();
    storageBarrier();
    let slot = atomicAdd(&header.count, 1u);
    atomicSub(&header.count, 2u);
    atomicMin(&header.lowest, i32(i));
    atomicMax(&header.lowest, -3);
    let previous = atomicExchange(&header.items[slot], i);
    result[0] = previous + atomicAnd(&words[0], 0xFFu) + atomicOr(&words[1], 1u) + atomicXor(&words[2], i);
    let exchange = atomicCompareExchangeWeak(&words[3], result[1], i);
    if exchange.exchanged {
        result[2] = exchange.old_value;
    }
    result[3] = atomicCompareExchangeWeak(&words[4], i, i + 1u).old_value;
    var expected = 0u;
    loop {
        let r = atomicCompareExchangeWeak(&words[5], expected, expected + 1u);
        if r.exchanged { break; }
        expected = r.old_value;
    }
    atomicAdd(&totals.used, atomicLoad(&shared_count));
    totals.lost = atomicLoad(&words[6]) + u32(atomicLoad(&header.lowest));
    result[4] = arrayLength(&header.items) + scratch[(i + 1u) % 64u] + group.x + groups.y;
    while atomicLoad(&words[7]) != 0u {
        if atomicExchange(&words[7], 1u) == 0u { break; }
    }
}
