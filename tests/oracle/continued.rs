//! An effect that iterations of peeling interrupt, and its image, computed here from the fragments of each pixel.

use fragbuf_model::{Variant, check};
use fragbuf_templates::Registry;

use super::scene::{Quad, first_difference};
use super::technique::BACKGROUND;

/// The fragment from which the effect returns.
const FIFTH: usize = 4;

/// Returns the effect over a technique: alternating sums of depths, until the fifth fragment.
pub fn continued(technique: &str) -> Variant {
    let text = format!(
        "buffer Continued from {technique} {{
            fragment {{ depth: f32 }}
            resolve |fragments| {{
                let half = 0.5;
                let mut sum = half;
                let mut sign = half;
                for (i, f) in fragments.iter().enumerate() {{
                    if i == {FIFTH} {{ return vec4(sum, 1.0, 0.0, 1.0); }}
                    sum += sign * f.depth;
                    sign = -sign;
                }}
                vec4(sum, 0.0, half, 1.0)
            }}
        }}"
    );
    let parsed = fragbuf_syntax::parse(&text, "continued.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Fails if an image of the effect is wrong. Some pixels must return early, and some must not.
pub fn assert_continued(what: &str, seen: &[[f32; 4]], quads: &[Quad], [width, height]: [u32; 2]) {
    let mut early = 0;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let expected: Vec<[f64; 3]> = pixels
        .map(|(x, y)| {
            let mut depths: Vec<f64> =
                quads.iter().filter(|quad| quad.covers(x, y)).map(|quad| f64::from(quad.depth)).collect();
            depths.sort_by(f64::total_cmp);
            let signs = [0.5, -0.5].into_iter().cycle();
            let sum: f64 = 0.5 + depths.iter().take(FIFTH).zip(signs).map(|(depth, sign)| sign * depth).sum::<f64>();
            match depths.len() {
                0 => BACKGROUND,
                count if count > FIFTH => {
                    early += 1;
                    [sum, 1.0, 0.0]
                }
                _ => [sum, 0.0, 0.5],
            }
        })
        .collect();
    assert!(early > 0 && early < expected.len(), "{what}: {early} pixels return early");
    assert_eq!(first_difference(seen, &expected), None, "{what}");
}
