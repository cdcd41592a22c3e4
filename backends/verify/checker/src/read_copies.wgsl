// Reads how many copies of a fragment a pixel has beside those that its storage holds, and the fragment: where iterations
// keep what earlier ones displace, copies of the boundary are counted and not stored.

@compute @workgroup_size(1)
fn read_copies() {
    let pixel = pixel_index(vec2<f32>(0.5));
    let copies = count_read(pixel, 0u);
    let copy = copied(pixel);
}

/// Returns how many fragments the effect reads if the storage holds `stored`: all of them and the copies, or none where an
/// iteration leaves what it has stored to a later one.
fn count_read(pixel: u32, stored: u32) -> u32 {
    peeling_resume(pixel);
    return peeling_layer_count(stored);
}

fn copied(pixel: u32) -> Packed {
    peeling_resume(pixel);
    return peeling_copy();
}
