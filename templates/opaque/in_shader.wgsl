// Opaque surfaces hide what lies behind them: the caller draws them first, and brings their depth buffer. Equal depths
// stay, as they pass a test by LESS_EQUAL: a decal that is drawn with the positions of its wall is seen. Depth is the
// fragment's own, which the caller's shader may have chosen. The depth buffer has one sample per pixel; where fragments
// have several, both depths are those at the pixel's middle, and a fragment is hidden there or nowhere.

fn opaque_hides(position: vec2<f32>, fragment: Fragment) -> bool {
    return fragment.depth > opaque_load(pixel_index(position));
}
