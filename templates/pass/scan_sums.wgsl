// Exclusive prefix sum over the sums of all blocks, in one workgroup that goes through them 256 at a time. The
// grand total is the end of the last pixel's region.

@compute @workgroup_size(256)
fn scan_sums(@builtin(local_invocation_index) local: u32) {
    let blocks = (pixel_count() + 1023u) / 1024u;
    var total = 0u;
    for (var first = 0u; first < blocks; first += 256u) {
        let block = first + local;
        var own = 0u;
        if block < blocks {
            own = block_sums_load(block);
        }
        let scanned = workgroup_scan(local, own);
        if block < blocks {
            block_sums_store(block, total + scanned - own);
        }
        total += sums[255];
    }
    if local == 0u {
        offsets_store(pixel_count(), total);
    }
}
