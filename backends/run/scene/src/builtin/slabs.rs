//! Translucent quads that face the viewer, at random places and depths. They lie within clip space, so that both cameras
//! show them.

use super::random::Random;
use super::{Object, Parameter, Row, SEED, hue, value};

pub(super) const ROW: Row = Row {
    name: "slabs",
    summary: "translucent quads of random depth",
    parameters: &[Parameter { name: "n", default: 16, range: (1, 65_536) }, SEED],
    make,
};

fn make(values: &[u32]) -> Vec<Object> {
    let mut random = Random::seeded(value(values, 1));
    (0..value(values, 0)).map(|index| slab(index, &mut random)).collect()
}

fn slab(index: u32, random: &mut Random) -> Object {
    let mut object = Object { name: format!("slab {index}"), ..Object::default() };
    let (x, y, z) = (random.between(-0.55, 0.55), random.between(-0.55, 0.55), random.between(0.02, 0.98));
    let (width, height) = (random.between(0.15, 0.4), random.between(0.15, 0.4));
    let color = hue(random.unit(), random.between(0.3, 0.6));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners =
        corners.map(|(a, b): (f32, f32)| object.vertex([x + a * width, y + b * height, z], [0.0, 0.0, -1.0], color));
    object.polygon(&corners);
    object
}
