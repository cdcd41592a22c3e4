//! The scene of the example: a sphere, a torus and a pane that intersect each other.

use std::f32::consts::{PI, TAU};

use fragbuf::glam::camera::rh::{proj::directx, view};
use fragbuf::glam::{Mat4, Vec3, vec3};

/// The direction towards the light, a unit vector, and the ambient light.
pub const LIGHT: [f32; 4] = [0.48, 0.64, 0.6, 0.25];

/// Position, normal, and linear colour with straight alpha.
pub type Vertex = [f32; 10];

/// Returns the triangles of each object.
pub fn objects() -> [Vec<Vertex>; 3] {
    let sphere = |u: f32, v: f32| {
        let normal = vec3((PI * v).sin() * (TAU * u).cos(), (PI * v).cos(), (PI * v).sin() * (TAU * u).sin());
        (0.8 * normal, normal)
    };
    let torus = |u: f32, v: f32| {
        let centre = vec3((TAU * u).cos(), 0.0, (TAU * u).sin());
        let normal = (TAU * v).cos() * centre + (TAU * v).sin() * Vec3::Y;
        (1.1 * centre + 0.35 * normal, normal)
    };
    let pane = |u: f32, v: f32| (vec3(2.6 * u - 1.3, 2.2 * v - 1.1, 1.2 * u - 0.6), vec3(-0.6, 0.0, 1.3).normalize());
    let (red, green, blue) = ([0.95, 0.2, 0.1], [0.1, 0.75, 0.2], [0.15, 0.3, 0.95]);
    [surface(red, (24, 12), sphere), surface(green, (32, 12), torus), surface(blue, (1, 1), pane)]
}

/// Returns the view-projection matrix, with depths from 0 to 1.
pub fn view_projection((width, height): (u32, u32)) -> Mat4 {
    let projection = directx::perspective(0.7, width as f32 / height as f32, 1.0, 7.0);
    projection * view::look_at_mat4(vec3(0.9, 1.9, 3.6), Vec3::ZERO, Vec3::Y)
}

/// Returns two triangles for each cell of a grid over a surface: `point` returns position and normal. Half of the light passes.
fn surface([r, g, b]: [f32; 3], (columns, rows): (u32, u32), point: impl Fn(f32, f32) -> (Vec3, Vec3)) -> Vec<Vertex> {
    let vertex = |(column, row): (u32, u32)| {
        let (p, n) = point(column as f32 / columns as f32, row as f32 / rows as f32);
        [p.x, p.y, p.z, n.x, n.y, n.z, r, g, b, 128.0 / 255.0]
    };
    let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row)));
    let corners = cells.flat_map(|(x, y)| [(x, y), (x + 1, y), (x, y + 1), (x, y + 1), (x + 1, y), (x + 1, y + 1)]);
    corners.map(vertex).collect()
}
