// Computes exclusive prefix sums of the pixels' region sizes inside each block of 1024 pixels: every invocation adds
// up four neighbours, and the workgroup scans the 256 sums. The block's total goes to `block_sums`.

const PIXELS_EACH = 4u;

@compute @workgroup_size(256)
fn scan_blocks(
    @builtin(local_invocation_index) local: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let first = (group.x * 256u + local) * PIXELS_EACH;
    let end = min(first + PIXELS_EACH, pixel_count());
    var value = 0u;
    for (var pixel = first; pixel < end; pixel++) {
        value += storage_size(pixel);
    }
    var offset = workgroup_scan(local, value) - value;
    for (var pixel = first; pixel < end; pixel++) {
        offsets_store(pixel, offset);
        offset += storage_size(pixel);
    }
    if local == 255u {
        block_sums_store(group.x, offset);
    }
}
