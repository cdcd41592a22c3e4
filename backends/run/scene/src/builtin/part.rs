//! A machine part before it is cut: a block, and the bodies to add to it and to remove from it.
//!
//! All bodies are closed, with their front sides outside. The part is the body (0) and the boss (1) without the bore (2), the cross bore (3), the
//! slot (4) and the dimple (5). On purpose some sides lie in one plane: the slot begins in the top of the block, and the bore ends in its bottom.

use glam::{Mat3, Vec3};

use super::row::{Objects, Parameter, Row, hue, no_memory, value};
use super::shapes::{Cylinder, ball, cuboid};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "part",
    summary: "bodies of a machine part: (body 0, boss 1) without bore 2, cross bore 3, slot 4 and dimple 5",
    parameters: &[Parameter { name: "sides", default: 64, range: (8, 512) }],
    attributes: &[],
    working: no_memory,
    generate,
};

/// Adds a body to an object, with so many sides around it.
type Body = fn(object: &mut Object, sides: u32, color: [f32; 4]);

/// The bodies: name, hue and shape.
const BODIES: [(&str, f32, Body); 6] = [
    ("body", 0.6, |object, _, color| {
        cuboid(object, [Vec3::new(-1.0, -0.5, -0.75), Vec3::new(1.0, 0.25, 0.75)], color);
    }),
    ("boss", 0.52, |object, sides, color| {
        // It stands in the block.
        upright(Vec3::new(-0.4, 0.15, 0.0), 0.5, 0.4).add(object, sides, color);
    }),
    ("bore", 0.05, |object, sides, color| {
        // From above the boss to the bottom of the block.
        upright(Vec3::new(-0.4, 0.1, 0.0), 0.28, 0.6).add(object, sides, color);
    }),
    ("cross bore", 0.1, |object, sides, color| {
        let turn = Mat3::from_rotation_x(std::f32::consts::FRAC_PI_2);
        Cylinder { centre: Vec3::new(0.55, -0.125, 0.0), turn, radius: 0.2, half: 1.0 }.add(object, sides, color);
    }),
    ("slot", 0.15, |object, _, color| {
        // Its top is in the plane of the block's top, and its end in that of the block's end.
        cuboid(object, [Vec3::new(0.35, 0.05, -0.2), Vec3::new(1.0, 0.25, 0.2)], color);
    }),
    ("dimple", 0.95, |object, sides, color| {
        ball(object, (Vec3::new(0.15, 0.4, 0.75), 0.3), (sides / 2).max(4), color);
    }),
];

fn upright(centre: Vec3, radius: f32, half: f32) -> Cylinder {
    Cylinder { centre, turn: Mat3::IDENTITY, radius, half }
}

fn generate(values: &[u32]) -> Objects {
    let sides = value(values, 0);
    Box::new(BODIES.into_iter().map(move |(name, tint, body)| {
        let mut object = Object { name: name.to_owned(), ..Object::default() };
        body(&mut object, sides, hue(tint, 0.45));
        object
    }))
}
