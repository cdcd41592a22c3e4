//! Long thin spikes, nearly parallel, each through the depth of the scene: every pixel sees many layers of many depths, and
//! neighbours see others. After the needle tree of Vasilakis et al. 2015
//! (C15), which is theirs alone.

use std::f32::consts::TAU;

use glam::Vec3;

use super::random::Random;
use super::{Object, Parameter, Row, SEED, hue, value};

pub(super) const ROW: Row = Row {
    name: "needles",
    summary: "long thin spikes, nearly parallel, through the depth of the scene; some 100 layers",
    parameters: &[Parameter { name: "n", default: 40_000, range: (1, 200_000) }, SEED],
    make,
};

/// Sides of a needle.
const SIDES: u32 = 3;
const LENGTH: f32 = 2.4;
/// At the blunt end.
const RADIUS: f32 = 0.014;
/// How far a tip strays, along each axis, from where all would point.
const STRAY: f32 = 0.12;

fn make(values: &[u32]) -> Vec<Object> {
    let mut random = Random::seeded(value(values, 1));
    (0..value(values, 0)).map(|index| needle(index, &mut random)).collect()
}

fn needle(index: u32, random: &mut Random) -> Object {
    let mut object = Object { name: format!("needle {index}"), ..Object::default() };
    let color = hue(random.between(0.25, 0.5), 0.1);
    let middle = Vec3::new(random.between(-1.0, 1.0), random.between(-0.7, 0.7), random.between(-1.0, 1.0));
    // Half of them point the other way, so that blunt ends lie before tips and behind them.
    let sense = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let way = (sense * Vec3::new(0.6, 0.1, 1.0).normalize() + STRAY * random.in_ball()).normalize_or(Vec3::Z);
    let (blunt, tip) = (middle - 0.5 * LENGTH * way, middle + 0.5 * LENGTH * way);
    let (u, v) = way.any_orthonormal_pair();
    for side in 0..SIDES {
        let [here, next] = [side, side + 1].map(|corner| {
            let (sine, cosine) = (TAU * corner as f32 / SIDES as f32).sin_cos();
            cosine * u + sine * v
        });
        let normal = (here + next).normalize_or(u).to_array();
        let corners = [blunt + RADIUS * here, blunt + RADIUS * next, tip];
        let corners = corners.map(|corner| object.vertex(corner.to_array(), normal, color));
        object.triangles.push(corners);
    }
    object
}
