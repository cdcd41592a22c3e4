// Rejects no fragment.

fn cull_fragment(pixel: u32, entry: Packed) -> bool {
    return false;
}
