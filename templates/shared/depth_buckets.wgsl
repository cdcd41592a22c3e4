// Equal parts of the depth range of a pixel. Depths are rounded down to multiples of 2^-24 and compared as integers,
// equally on every device.

/// Returns the part of the range from the key `nearest` to the key `farthest` that a key is in, of at most 256. A key
/// outside the range counts as the nearer or the farther end of it.
fn depth_bucket(key: u32, nearest: u32, farthest: u32, buckets: u32) -> u32 {
    let begin = depth_buckets_steps(nearest);
    let span = max(depth_buckets_steps(farthest), begin) - begin + 1u;
    let beyond = max(depth_buckets_steps(key), begin) - begin;
    return min(beyond, span - 1u) * buckets / span;
}

/// Returns the depth of a key in units of 2^-24. A depth beyond 1 counts as 1.
fn depth_buckets_steps(key: u32) -> u32 {
    return u32(bitcast<f32>(min(key, 0x3f800000u)) * 16777216.0);
}
