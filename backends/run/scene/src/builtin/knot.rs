//! A closed tube along a torus knot. A thick one runs into itself.

use std::f32::consts::TAU;

use glam::Vec3;

use super::row::{Objects, Parameter, Row, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "knot",
    summary: "a tube along a torus knot; a thick one, from about 30 per cent, runs into itself",
    parameters: &[
        Parameter { name: "turns", default: 3, range: (1, 32) },
        Parameter { name: "thickness", default: 20, range: (1, 100) },
        Parameter { name: "rings", default: 256, range: (3, 65536) },
        Parameter { name: "sides", default: 32, range: (3, 1024) },
    ],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The turns around the axis of the torus.
const WINDINGS: f32 = 2.0;

/// The radius of the torus's tube, where that of its centre line is 1.
const DEPTH: f32 = 0.45;

fn generate(values: &[u32]) -> Objects {
    let [turns, thickness, rings, sides] = [0, 1, 2, 3].map(|index| value(values, index));
    Box::new(std::iter::once(tube(turns as f32, 0.01 * thickness as f32, rings, sides)))
}

/// Returns the tube. Its colours follow its length.
fn tube(turns: f32, radius: f32, rings: u32, sides: u32) -> Object {
    let mut object = Object { name: "knot".to_owned(), ..Object::default() };
    let step = TAU / rings as f32;
    for ring in 0..rings {
        let at = ring as f32 * step;
        let centre = point(turns, at);
        let along = (point(turns, at + 0.1 * step) - point(turns, at - 0.1 * step)).normalize_or(Vec3::X);
        // The torus's axis of symmetry is never along the curve.
        let across = along.cross(centre - point(0.0, at)).normalize_or(Vec3::Z);
        let up = across.cross(along);
        for side in 0..sides {
            let (sin, cos) = (TAU * side as f32 / sides as f32).sin_cos();
            let normal = cos * across + sin * up;
            let color = hue((ring as f32 / rings as f32).fract(), 0.5);
            object.vertex((centre + radius * normal).to_array(), normal.to_array(), color);
        }
    }
    for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
        let vertex = |ring: u32, side: u32| ring % rings * sides + side % sides;
        let corners = [vertex(ring, side), vertex(ring + 1, side), vertex(ring + 1, side + 1), vertex(ring, side + 1)];
        object.polygon(&corners);
    }
    object
}

/// Returns a point of the knot; with no turns, of the centre line of its torus.
fn point(turns: f32, at: f32) -> Vec3 {
    let (sin, cos) = (WINDINGS * at).sin_cos();
    let (height, width) = (turns * at).sin_cos();
    let (height, width) = if turns == 0.0 { (0.0, 0.0) } else { (DEPTH * height, DEPTH * width) };
    Vec3::new((1.0 + width) * cos, (1.0 + width) * sin, height)
}
