//! Three translucent cubes, each intersecting the next.

use glam::{Quat, Vec3};

use super::row::{Objects, Row, no_memory};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "cubes",
    summary: "three translucent cubes, each intersecting the next",
    parameters: &[],
    attributes: &[],
    working: no_memory,
    generate,
};

fn generate(_: &[u32]) -> Objects {
    let cubes = [
        ("red", Vec3::new(-0.7, -0.1, 0.3), 0.3, [0.85, 0.12, 0.1, 0.45]),
        ("green", Vec3::new(0.0, 0.15, -0.2), -0.2, [0.15, 0.7, 0.2, 0.45]),
        ("blue", Vec3::new(0.65, -0.15, 0.35), 0.7, [0.12, 0.25, 0.9, 0.45]),
    ];
    Box::new(
        cubes.into_iter().map(|(name, centre, turn, color)| cube(name, centre, Quat::from_rotation_y(turn), color)),
    )
}

fn cube(name: &str, centre: Vec3, turn: Quat, color: [f32; 4]) -> Object {
    let mut object = Object { name: name.to_owned(), ..Object::default() };
    for normal in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
        let (u, v) = normal.any_orthonormal_pair();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b): (f32, f32)| {
            let position = centre + turn * (0.5 * (normal + a * u + b * v));
            object.vertex(position.to_array(), (turn * normal).to_array(), color)
        });
        object.polygon(&corners);
    }
    object
}
