//! Long thin spikes, nearly parallel, each through the depth of the scene. Every pixel has many layers, and neighbouring
//! pixels have others. After the needle tree of Vasilakis et al. 2015 (C15), which is not public.

use std::f32::consts::TAU;

use glam::Vec3;

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "needles",
    summary: "long thin spikes, nearly parallel, through the depth of the scene; some 100 layers",
    parameters: &[Parameter { name: "n", default: 40_000, range: (1, 200_000) }, SEED],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The sides of a needle.
const SIDES: u32 = 3;
const LENGTH: f32 = 2.4;
/// The radius of the blunt end.
const RADIUS: f32 = 0.014;
/// The greatest random deviation of a direction, along each axis.
const DEVIATION: f32 = 0.12;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    Box::new((0..value(values, 0)).map(move |index| needle(index, &mut rng)))
}

fn needle(index: u32, rng: &mut Rng) -> Object {
    let mut object = Object { name: format!("needle {index}"), ..Object::default() };
    let color = hue(rng.between(0.25, 0.5), 0.1);
    let centre = Vec3::new(rng.between(-1.0, 1.0), rng.between(-0.7, 0.7), rng.between(-1.0, 1.0));
    // Every second needle points the other way, so blunt ends are in front of tips and behind them.
    let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let direction = (sign * Vec3::new(0.6, 0.1, 1.0).normalize() + DEVIATION * rng.in_ball()).normalize_or(Vec3::Z);
    let (blunt, tip) = (centre - 0.5 * LENGTH * direction, centre + 0.5 * LENGTH * direction);
    let (u, v) = direction.any_orthonormal_pair();
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
