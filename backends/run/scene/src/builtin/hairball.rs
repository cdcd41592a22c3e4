//! Thin tubes that wander through a ball, with far more layers than any k, after the hairball of Samuli Laine.

use std::f32::consts::TAU;

use glam::Vec3;

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "hairball",
    summary: "thin tubes through a ball; over 2 M triangles and some 150 layers",
    parameters: &[Parameter { name: "strands", default: 3600, range: (1, 100_000) }, SEED],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The pieces of a strand.
const PIECES: u32 = 100;
/// The sides of a tube.
const SIDES: u32 = 3;
/// The length of a piece.
const STEP: f32 = 0.04;
const RADIUS: f32 = 0.008;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    Box::new((0..value(values, 0)).map(move |index| strand(index, &mut rng)))
}

fn strand(index: u32, rng: &mut Rng) -> Object {
    let mut object = Object { name: format!("strand {index}"), ..Object::default() };
    let color = hue(rng.between(0.02, 0.14), 0.2);
    let mut at = rng.in_ball();
    let mut direction = rng.in_ball().normalize_or(Vec3::X);
    for piece in 0..=PIECES {
        let (u, v) = direction.any_orthonormal_pair();
        for side in 0..SIDES {
            let (sine, cosine) = (TAU * side as f32 / SIDES as f32).sin_cos();
            let normal = cosine * u + sine * v;
            object.vertex((at + RADIUS * normal).to_array(), normal.to_array(), color);
        }
        if piece > 0 {
            tube(&mut object, SIDES * (piece - 1));
        }
        at += STEP * direction;
        // Bends at random, and towards the centre in proportion to the distance outside.
        let inward = (at.length() - 0.8).max(0.0) * 4.0;
        direction = (direction + 0.35 * rng.in_ball() - inward * STEP * 4.0 * at).normalize_or(Vec3::X);
    }
    object
}

/// Adds the piece whose first ring begins at vertex `first`.
fn tube(object: &mut Object, first: u32) {
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        let [a, b, c, d] = [first + side, first + next, first + SIDES + next, first + SIDES + side];
        object.triangles.extend([[a, b, c], [a, c, d]]);
    }
}
