//! Translucent quads that face the viewer, at random positions and depths. They are within clip space, so both cameras show
//! them.

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "slabs",
    summary: "translucent quads of random depth",
    parameters: &[Parameter { name: "n", default: 16, range: (1, 65_536) }, SEED],
    attributes: &[],
    working: no_memory,
    generate,
};

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    Box::new((0..value(values, 0)).map(move |index| slab(index, &mut rng)))
}

fn slab(index: u32, rng: &mut Rng) -> Object {
    let mut object = Object { name: format!("slab {index}"), ..Object::default() };
    let (x, y, z) = (rng.between(-0.55, 0.55), rng.between(-0.55, 0.55), rng.between(0.02, 0.98));
    let (width, height) = (rng.between(0.15, 0.4), rng.between(0.15, 0.4));
    let color = hue(rng.unit(), rng.between(0.3, 0.6));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners =
        corners.map(|(a, b): (f32, f32)| object.vertex([x + a * width, y + b * height, z], [0.0, 0.0, -1.0], color));
    object.polygon(&corners);
    object
}
