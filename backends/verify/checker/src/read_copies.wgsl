// Reads how many copies of a fragment a pixel has beside those that its storage holds, and the fragment: where iterations
// keep what earlier ones displace, copies of the boundary are counted and not stored.

@compute @workgroup_size(1)
fn read_copies() {
    let pixel = pixel_index(vec2<f32>(0.5));
    let copies = count_copies(pixel);
    let copy = copied(pixel);
}

fn count_copies(pixel: u32) -> u32 {
    peeling_resume(pixel);
    return peeling_layer_count(0u);
}

fn copied(pixel: u32) -> Packed {
    peeling_resume(pixel);
    return peeling_copy();
}
