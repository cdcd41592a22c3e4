// Workgroups: shared memory, barriers and built-in ids. Compared exactly.

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

var<workgroup> sums: array<u32, 32>;
var<workgroup> total: atomic<u32>;
var<workgroup> first: u32;

@compute @workgroup_size(8, 4)
fn main(
    @builtin(local_invocation_index) local: u32,
    @builtin(local_invocation_id) place: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(global_invocation_id) everywhere: vec3<u32>,
) {
    sums[local] = words[local];
    atomicAdd(&total, words[local]);
    if local == 0u {
        first = words[3];
    }
    workgroupBarrier();
    for (var distance = 1u; distance < 32u; distance *= 2u) {
        var before = 0u;
        if local >= distance {
            before = sums[local - distance];
        }
        workgroupBarrier();
        sums[local] += before;
        workgroupBarrier();
    }
    let start = workgroupUniformLoad(&first);
    let number = (group.y * groups.x + group.x) * 32u + local;
    results[number] = sums[local] ^ (place.x * 1000u + place.y * 100000u) ^ everywhere.y ^ start;
    if local == 31u {
        results[number] ^= atomicLoad(&total);
    }
}
