// Opaque surfaces hide what lies behind them: the caller draws them first, and brings their depth buffer. Equal depths
// stay, as they pass a test by LESS_EQUAL: a decal that is drawn with the positions of its wall is seen. Depth is the
// fragment's own, which the caller's shader may have chosen.

fn opaque_hides(position: vec2<f32>, fragment: Fragment) -> bool {
    return fragment.depth > opaque_load(pixel_index(position));
}
