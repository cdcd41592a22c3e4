//! Quads over the whole frame, each a tilted plane at a random depth, so that the order of depths differs between pixels: the scene of
//! the measurements of Vasilakis et al. 2015 (K15, section 5.1), where every pixel has n fragments in random order. They are within clip
//! space: `--camera clip` shows n fragments in every pixel.

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "layers",
    summary: "n tilted quads over the whole frame, in random order of depth (with --camera clip)",
    parameters: &[Parameter { name: "n", default: 16, range: (1, 65_536) }, SEED],
    generate,
};

/// The greatest distance of a corner's depth from that of the centre.
const TILT: f32 = 0.2;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    Box::new((0..value(values, 0)).map(move |index| layer(index, &mut rng)))
}

fn layer(index: u32, rng: &mut Rng) -> Object {
    let mut object = Object { name: format!("layer {index}"), ..Object::default() };
    let depth = rng.between(TILT, 1.0 - TILT);
    // The depths of the four corners are those of one plane.
    let [slope_x, slope_y] = [(); 2].map(|()| rng.between(-0.5 * TILT, 0.5 * TILT));
    let color = hue(rng.unit(), rng.between(0.05, 0.2));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners
        .map(|(x, y): (f32, f32)| object.vertex([x, y, depth + x * slope_x + y * slope_y], [0.0, 0.0, -1.0], color));
    object.polygon(&corners);
    object
}
