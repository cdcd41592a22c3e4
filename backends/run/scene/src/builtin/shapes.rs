//! Closed bodies with their front sides outside: boxes, cylinders and balls. Flat sides have flat normals, round sides smooth ones. Points
//! that two sides share have equal coordinates.

use std::f32::consts::{PI, TAU};

use glam::{Mat3, Vec3};

use crate::Object;

/// Adds a box between two corners.
pub(super) fn cuboid(object: &mut Object, [least, greatest]: [Vec3; 2], color: [f32; 4]) {
    for axis in 0..3 {
        for is_far in [false, true] {
            side(object, [least, greatest], (axis, is_far), color);
        }
    }
}

/// Adds the side of a box that is perpendicular to an axis, at its least or greatest coordinate.
pub(super) fn side(object: &mut Object, bounds: [Vec3; 2], (axis, is_far): (usize, bool), color: [f32; 4]) {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let at = |far: [bool; 3]| std::array::from_fn(|axis| bounds[usize::from(far[axis])][axis]);
    let corner = |far_u: bool, far_v: bool| {
        let mut far = [is_far; 3];
        (far[u], far[v]) = (far_u, far_v);
        at(far)
    };
    let mut normal = [0.0; 3];
    normal[axis] = if is_far { 1.0 } else { -1.0 };
    let corners = [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
    let indices = corners.map(|position: [f32; 3]| object.vertex(position, normal, color));
    // The same diagonal on both sides, so that equal rectangles have equal triangles.
    let [a, b, c, d] = indices;
    object.polygon(&if is_far { [a, b, c, d] } else { [a, d, c, b] });
}

/// A cylinder along the y axis of `turn`, with its centre, its radius and half of its length.
pub(super) struct Cylinder {
    pub(super) centre: Vec3,
    pub(super) turn: Mat3,
    pub(super) radius: f32,
    pub(super) half: f32,
}

impl Cylinder {
    /// Adds the cylinder with so many sides.
    pub(super) fn add(&self, object: &mut Object, sides: u32, color: [f32; 4]) {
        let place = |point: Vec3| (self.centre + self.turn * point).to_array();
        let around = |side: u32| {
            let (sine, cosine) = (TAU * (side % sides) as f32 / sides as f32).sin_cos();
            Vec3::new(cosine, 0.0, -sine)
        };
        let rim = |side: u32, y: f32| place(self.radius * around(side) + y * Vec3::Y);
        for side in 0..sides {
            let corners = [(side, -1.0), (side + 1, -1.0), (side + 1, 1.0), (side, 1.0)].map(|(side, end)| {
                object.vertex(rim(side, end * self.half), (self.turn * around(side)).to_array(), color)
            });
            object.polygon(&corners);
        }
        for end in [-1.0, 1.0] {
            let normal = (self.turn * (end * Vec3::Y)).to_array();
            let ring: Vec<u32> = (0..sides)
                .map(|side| if end > 0.0 { side } else { sides - 1 - side })
                .map(|side| object.vertex(rim(side, end * self.half), normal, color))
                .collect();
            object.polygon(&ring);
        }
    }
}

/// Adds a ball with rings from pole to pole, and twice as many sectors.
pub(super) fn ball(object: &mut Object, (centre, radius): (Vec3, f32), rings: u32, color: [f32; 4]) {
    let sectors = 2 * rings;
    let first = object.positions.len() as u32;
    let mut vertex = |normal: Vec3| object.vertex((centre + radius * normal).to_array(), normal.to_array(), color);
    let top = vertex(Vec3::Y);
    for ring in 1..rings {
        let (width, height) = (PI * ring as f32 / rings as f32).sin_cos();
        for sector in 0..sectors {
            let (sine, cosine) = (TAU * sector as f32 / sectors as f32).sin_cos();
            vertex(Vec3::new(width * cosine, height, -width * sine));
        }
    }
    let bottom = vertex(Vec3::NEG_Y);
    let at = |ring: u32, sector: u32| first + 1 + (ring - 1) * sectors + sector % sectors;
    for sector in 0..sectors {
        object.triangles.push([top, at(1, sector), at(1, sector + 1)]);
        object.triangles.push([bottom, at(rings - 1, sector + 1), at(rings - 1, sector)]);
        for ring in 1..rings - 1 {
            object.polygon(&[at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1)]);
        }
    }
}
