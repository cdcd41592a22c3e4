// Computes the exclusive prefix sum over the sums of all blocks, in one workgroup that processes 256 at a time. The
// grand total is the end of the last pixel's region.

@compute @workgroup_size(256)
fn scan_sums(@builtin(local_invocation_index) local: u32) {
    let blocks = (pixel_count() + 1023u) / 1024u;
    var total = 0u;
    for (var first = 0u; first < blocks; first += 256u) {
        let block = first + local;
        var value = 0u;
        if block < blocks {
            value = block_sums_load(block);
        }
        let scanned = workgroup_scan(local, value);
        if block < blocks {
            block_sums_store(block, total + scanned - value);
        }
        total += sums[255];
    }
    if local == 0u {
        offsets_store(pixel_count(), total);
    }
}
