//! A description that reads `front`, and a closed tetrahedron to draw with it: along each ray the sides alternate.

use fragbuf_model::{Variant, check};
use fragbuf_templates::Registry;

/// Red is 1 where a side is not the expected one, green a quarter of the number of fragments.
pub const SIDES: &str = "
buffer Sides from kplus_array {
    fragment { depth: f32, front: u32 }
    keep 4 least |f| f.depth;
    resolve |fragments| {
        let mut wrong = 0.0;
        let mut expected = 1;
        for f in fragments {
            if f.front != expected { wrong = 1.0; }
            expected = 1 - expected;
        }
        vec4(wrong, 0.25 * fragments.len() as f32, 0.0, 1.0)
    }
}";

pub fn sides() -> Variant {
    let parsed = fragbuf_syntax::parse(SIDES, "sides.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// Returns the positions of the triangles in clip space, three floats each. The corners of the three near faces are counter-clockwise in
/// the image; `is_mirrored` turns every face.
pub fn tetrahedron(is_mirrored: bool) -> Vec<u8> {
    let (a, b, c, near) = ([-0.8, -0.8, 0.9], [0.8, -0.8, 0.9], [0.0, 0.8, 0.9], [0.0, -0.2, 0.1_f32]);
    let turned = |[a, b, c]: [[f32; 3]; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
    let faces = [[a, b, near], [b, c, near], [c, a, near], [a, c, b]].map(turned);
    faces.iter().flatten().flatten().flat_map(|value| value.to_le_bytes()).collect()
}

/// Compares an image of [`tetrahedron`].
pub fn assert_sides(pixels: &[[f32; 4]], is_mirrored: bool, what: &str) {
    let covered: Vec<&[f32; 4]> = pixels.iter().filter(|[_, green, ..]| *green > 0.0).collect();
    assert!(5 * covered.len() > pixels.len() && covered.len() < pixels.len(), "{what}: {} covered", covered.len());
    let expected = [if is_mirrored { 1.0 } else { 0.0 }, 0.5, 0.0, 1.0];
    let is_expected = |pixel: &&&[f32; 4]| pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0 / 255.0);
    let wrong = covered.iter().find(|pixel| !is_expected(pixel));
    assert_eq!(wrong, None, "{what}: not {expected:?}");
}
