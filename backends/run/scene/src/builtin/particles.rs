//! Particles around a knot: small balls, each an object, with a scalar that falls off from the middle of the strand.

use std::f32::consts::TAU;

use glam::Vec3;

use super::random::Rng;
use super::row::{Attribute, Objects, Parameter, Row, SEED, hue, no_memory, value};
use super::shapes::ball;
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "particles",
    summary: "small balls along a knot, an object each, with scalar, centre and radius; size is in per cent",
    parameters: &[
        Parameter { name: "n", default: 4000, range: (1, 200_000) },
        SEED,
        Parameter { name: "size", default: 100, range: (1, 1000) },
    ],
    attributes: &[
        Attribute { name: "scalar", components: 1, is_integer: false },
        Attribute { name: "centre", components: 3, is_integer: false },
        Attribute { name: "radius", components: 1, is_integer: false },
    ],
    working: no_memory,
    generate,
};

/// The rings of a ball.
const RINGS: u32 = 6;

/// The radius of the strand.
const STRAND: f32 = 0.3;

fn generate(values: &[u32]) -> Objects {
    let (count, mut rng) = (value(values, 0), Rng::seeded(value(values, 1)));
    // The balls fill about a sixth of the strand, whatever their number, if their size is 100.
    let size = value(values, 2) as f32 / 100.0 * (0.4 / count as f32).cbrt();
    Box::new((0..count).map(move |index| particle(index, size, &mut rng)))
}

fn particle(index: u32, size: f32, rng: &mut Rng) -> Object {
    let offset = rng.in_ball();
    let centre = knot(rng.unit()) + STRAND * offset;
    let radius = size * rng.between(0.4, 0.8);
    let scalar = 1.0 - offset.length();
    let mut object = Object { name: format!("particle {index}"), ..Object::default() };
    ball(&mut object, (centre, radius), RINGS, hue(0.6 - 0.55 * scalar, 0.35 + 0.4 * scalar));
    let count = object.positions.len();
    let repeated = |words: &[f32]| words.iter().map(|word| word.to_bits()).collect::<Vec<u32>>().repeat(count);
    object.attributes = vec![repeated(&[scalar]), repeated(&centre.to_array()), repeated(&[radius])];
    object
}

/// Returns the point of a trefoil knot, whose parameter goes from 0 to 1.
fn knot(at: f32) -> Vec3 {
    let angle = TAU * at;
    let width = 1.0 + 0.5 * (3.0 * angle).cos();
    Vec3::new(width * (2.0 * angle).cos(), width * (2.0 * angle).sin(), 0.6 * (3.0 * angle).sin())
}
