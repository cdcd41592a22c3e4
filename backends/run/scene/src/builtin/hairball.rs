//! Thin tubes that wander through a ball, far more layers than any k: the hardest case of the field, after the hairball of
//! Samuli Laine.

use std::f32::consts::TAU;

use glam::Vec3;

use super::random::Random;
use super::{Object, Parameter, Row, SEED, hue, value};

pub(super) const ROW: Row = Row {
    name: "hairball",
    summary: "thin tubes through a ball; over 2 M triangles and some 150 layers",
    parameters: &[Parameter { name: "strands", default: 3600, range: (1, 100_000) }, SEED],
    make,
};

/// Pieces of a strand.
const PIECES: u32 = 100;
/// Sides of a tube.
const SIDES: u32 = 3;
/// How far one piece goes.
const STEP: f32 = 0.04;
const RADIUS: f32 = 0.008;

fn make(values: &[u32]) -> Vec<Object> {
    let mut random = Random::seeded(value(values, 1));
    (0..value(values, 0)).map(|index| strand(index, &mut random)).collect()
}

fn strand(index: u32, random: &mut Random) -> Object {
    let mut object = Object { name: format!("strand {index}"), ..Object::default() };
    let color = hue(random.between(0.02, 0.14), 0.2);
    let mut at = random.in_ball();
    let mut way = random.in_ball().normalize_or(Vec3::X);
    for piece in 0..=PIECES {
        let (u, v) = way.any_orthonormal_pair();
        for side in 0..SIDES {
            let (sine, cosine) = (TAU * side as f32 / SIDES as f32).sin_cos();
            let normal = cosine * u + sine * v;
            object.vertex((at + RADIUS * normal).to_array(), normal.to_array(), color);
        }
        if piece > 0 {
            tube(&mut object, SIDES * (piece - 1));
        }
        at += STEP * way;
        // Bent at random, and back towards the middle the farther out it is.
        let back = (at.length() - 0.8).max(0.0) * 4.0;
        way = (way + 0.35 * random.in_ball() - back * STEP * 4.0 * at).normalize_or(Vec3::X);
    }
    object
}

/// The piece whose first ring begins at vertex `first`.
fn tube(object: &mut Object, first: u32) {
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        let [a, b, c, d] = [first + side, first + next, first + SIDES + next, first + SIDES + side];
        object.triangles.extend([[a, b, c], [a, c, d]]);
    }
}
