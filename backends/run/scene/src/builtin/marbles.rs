//! Translucent balls of many colours in a heap.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "marbles",
    summary: "translucent balls of many colours",
    parameters: &[Parameter { name: "n", default: 48, range: (1, 4096) }, SEED],
    attributes: &[],
    working: no_memory,
    generate,
};

const RINGS: u32 = 24;
const SECTORS: u32 = 48;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    let count = value(values, 0);
    // Balls of this size fill about a quarter of the heap, whatever their number.
    let size = (0.25 / count as f32).cbrt();
    let marble = move |index| {
        let centre = rng.in_ball();
        let radius = size * rng.between(0.6, 1.3);
        ball(format!("marble {index}"), centre, radius, hue(rng.unit(), rng.between(0.25, 0.6)))
    };
    Box::new((0..count).map(marble))
}

fn ball(name: String, centre: Vec3, radius: f32, color: [f32; 4]) -> Object {
    let mut object = Object { name, ..Object::default() };
    for ring in 0..=RINGS {
        let (height, width) = ((PI * ring as f32 / RINGS as f32).cos(), (PI * ring as f32 / RINGS as f32).sin());
        for sector in 0..=SECTORS {
            let angle = TAU * sector as f32 / SECTORS as f32;
            let normal = Vec3::new(width * angle.cos(), height, width * angle.sin());
            object.vertex((centre + radius * normal).to_array(), normal.to_array(), color);
        }
    }
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let (here, below) = (ring * (SECTORS + 1) + sector, (ring + 1) * (SECTORS + 1) + sector);
            // At a pole one of the two triangles has no area.
            if ring > 0 {
                object.triangles.push([here, here + 1, below + 1]);
            }
            if ring + 1 < RINGS {
                object.triangles.push([here, below + 1, below]);
            }
        }
    }
    object
}
