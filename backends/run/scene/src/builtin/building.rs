//! A building of rooms: neighbouring rooms share the planes of their walls and floors, so that most fragments have a fragment of equal depth.
//!
//! A room is a closed box. Its windows lie in the plane of its outer wall, and a curtain in the plane of the window.

use glam::Vec3;

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, no_memory, value};
use super::shapes::{cuboid, side};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "building",
    summary: "rooms whose walls, floors, windows and curtains lie in shared planes",
    parameters: &[
        Parameter { name: "storeys", default: 8, range: (1, 128) },
        Parameter { name: "rooms", default: 6, range: (1, 64) },
        SEED,
    ],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The size of a room: its width and depth are equal. Multiples are exact in `f32`.
const WIDTH: f32 = 0.5;
const HEIGHT: f32 = 0.3125;

/// The parts of a wall to the left of a window, below it and below its upper edge.
const WINDOW: [f32; 3] = [0.125, 0.25, 0.875];

const GLASS: [f32; 4] = [0.25, 0.5, 0.85, 0.35];

fn generate(values: &[u32]) -> Objects {
    let (storeys, rooms, mut rng) = (value(values, 0), value(values, 1), Rng::seeded(value(values, 2)));
    let count = storeys * rooms * rooms;
    Box::new((0..count).map(move |index| {
        let [x, y, z] = [index % rooms, index / (rooms * rooms), index / rooms % rooms];
        room([x, y, z], [rooms, rooms], &mut rng)
    }))
}

/// Returns a room by its position in the building.
fn room([x, y, z]: [u32; 3], [across, deep]: [u32; 2], rng: &mut Rng) -> Object {
    let mut object = Object { name: format!("room {y}.{z}.{x}"), ..Object::default() };
    let corner = |x: u32, y: u32, z: u32| Vec3::new(x as f32 * WIDTH, y as f32 * HEIGHT, z as f32 * WIDTH);
    let bounds = [corner(x, y, z), corner(x + 1, y + 1, z + 1)];
    let shade = rng.between(0.55, 0.9);
    cuboid(&mut object, bounds, [shade, 0.92 * shade, 0.8 * shade, 0.3]);
    let curtain = [rng.between(0.5, 0.9), rng.between(0.15, 0.4), rng.between(0.1, 0.3), 0.5];
    // Axis 0 has its outer walls at the ends of a row, axis 2 in the first and the last row.
    for (wall, is_outer) in
        [((0, false), x == 0), ((0, true), x + 1 == across), ((2, false), z == 0), ((2, true), z + 1 == deep)]
    {
        if is_outer {
            let window = window(bounds, wall.0);
            side(&mut object, window, wall, GLASS);
            let half = [window[0], window[0].lerp(window[1], 0.5).with_y(window[1].y)];
            side(&mut object, drawn(half, bounds, wall.0), wall, curtain);
        }
    }
    object
}

/// Returns the bounds of the window in the walls of a room that are perpendicular to an axis. Along this axis they are those of the room.
fn window([least, greatest]: [Vec3; 2], axis: usize) -> [Vec3; 2] {
    let [left, bottom, top] = WINDOW;
    let size = greatest - least;
    let along = |part: f32, height: f32| {
        let mut point = least + size * Vec3::new(part, height, part);
        point[axis] = 0.0;
        point
    };
    let across = |from: Vec3| {
        let mut point = Vec3::ZERO;
        point[axis] = from[axis];
        point
    };
    [along(left, bottom) + across(least), along(1.0 - left, top) + across(greatest)]
}

/// Returns bounds with those of the room along an axis.
fn drawn([mut from, mut to]: [Vec3; 2], [least, greatest]: [Vec3; 2], axis: usize) -> [Vec3; 2] {
    (from[axis], to[axis]) = (least[axis], greatest[axis]);
    [from, to]
}
