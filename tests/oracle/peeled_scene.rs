//! A scene for the loop of `peeling_loop`, and the registry that has it as a storage. The tests of hosts share this file.

use fragbuf_follow::Object;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Compare, Objects, Pass, Step};

use super::numbers::Numbers;
use super::peeling_loop::{BLEND, PEEL, depth, peeling_loop, peeling_resources};
use super::scene::{Quad, image, over_background, quads};
use super::technique::BACKGROUND;
use super::tested_storage;

pub const SIZE: [u32; 2] = [13, 7];

const BOXES: &str = "
@fragment
fn boxes() {}
";

/// Returns the registry with front-to-back peeling as a storage, and the technique `tested`.
pub fn registry(objects: Objects, before: Option<Pass>) -> Registry {
    let steps = vec![Step::Repeat(peeling_loop("peel", "64", objects, before, "output"))];
    tested_storage::registry(peeling_resources(), steps, &[("peel", PEEL), ("blend", BLEND), ("boxes", BOXES)])
}

/// Returns a quad as an object. Its box is flat.
pub fn object(index: usize, quad: &Quad) -> Object {
    let x = quad.x.map(|x| 2.0 * x as f32 / SIZE[0] as f32 - 1.0);
    let y = quad.y.map(|y| 1.0 - 2.0 * y as f32 / SIZE[1] as f32);
    let bounds = [[x[0], y[1], quad.depth], [x[1], y[0], quad.depth]];
    Object { first: 6 * index as u32, count: 6, bounds }
}

/// Returns nine quads of different depths: peeling keeps one of several equal depths.
pub fn layers() -> Vec<Quad> {
    let mut quads = quads(9, SIZE, &mut Numbers::seeded(11));
    quads.iter_mut().enumerate().for_each(|(index, quad)| quad.depth = 0.05 + 0.1 * (index * 4 % 9) as f32);
    quads
}

/// Compares the image of peeled layers over a transparent background with that of the reference.
pub fn assert_peeled(what: &str, peeled: &[[f32; 4]], quads: &[Quad]) {
    let expected = image(quads, SIZE, None, BACKGROUND);
    assert_eq!(peeled.len(), expected.len());
    for (pixel, (seen, expected)) in peeled.iter().zip(&expected).enumerate() {
        let seen = over_background(seen.map(f64::from), BACKGROUND);
        // Half floats round each layer.
        let is_near = seen.iter().zip(expected).all(|(seen, expected)| (seen - expected).abs() < 2.0 / 255.0);
        assert!(is_near, "{what}, pixel {pixel}: {seen:?}, not {expected:?}");
    }
}

/// Returns the registry whose loop draws the objects with visible boxes.
pub fn registry_with_boxes() -> Registry {
    let mut boxes = Pass::geometry("boxes", "boxes");
    boxes.state.depth = depth("last", Compare::Greater, false);
    registry(Objects::Visible("boxes".to_owned()), Some(Pass { objects: Objects::Boxes, ..boxes }))
}
