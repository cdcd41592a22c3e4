// Opaque surfaces hide fragments behind them: the caller draws the surfaces first and supplies their depth buffer.
// Fragments of equal depth are kept, as with a LESS_EQUAL test, so a decal drawn at the positions of its wall is
// visible. The depth is the fragment's, which the caller's shader may have replaced. The depth buffer has one sample
// per pixel. If fragments have several, both depths are those at the pixel centre, and a fragment is hidden in all
// samples or in none.

fn opaque_hides(position: vec2<f32>, fragment: Fragment) -> bool {
    return fragment.depth > opaque_load(pixel_index(position));
}
