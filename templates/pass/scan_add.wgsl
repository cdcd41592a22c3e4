// Adds the sum of all preceding blocks to each pixel's offset.

@compute @workgroup_size(256)
fn scan_add(
    @builtin(local_invocation_index) local: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let first = group.x * 1024u;
    for (var pixel = first + local; pixel < min(first + 1024u, pixel_count()); pixel += 256u) {
        offsets_store(pixel, offsets_load(pixel) + block_sums_load(group.x));
    }
}
