//! The reference of shadows by a midpoint shadow map: Woo 1992. The map is computed here by rays from a lamp, and shadows by rays to it.

use super::layers::color;
use super::ray::{Hit, Ray};
use super::solids::{Solids, Triangle, cross, dot, scale, sub, unit};
use super::{Number, Texels};

/// The columns and rows of the map.
const MAP: [u32; 2] = [96, 80];

/// The lamp, which looks along the third of three axes of length 7.
const LAMP: [f64; 3] = [-6.0 / 7.0, 9.0 / 7.0, 0.5 - 18.0 / 7.0];
const AXES: [[f64; 3]; 3] = [[6.0, -2.0, -3.0], [3.0, 6.0, 2.0], [2.0, -3.0, 6.0]];

/// The tangent of half its angle of view, and the distances of its near and far plane.
const TANGENT: f64 = 0.6;
const NEAR: f64 = 1.25;
const FAR: f64 = 4.75;

/// Distances from the lamp, relative to one of them, that a device may compute in another order.
const NEARLY: f64 = 1e-4;

/// Returns a row of the matrix: a multiple of a coordinate of the lamp, plus a number.
const fn row(axis: usize, factor: f64, plus: f64) -> Number {
    let axis = AXES[axis];
    let [x, y, z] = [factor * axis[0] / 7.0, factor * axis[1] / 7.0, factor * axis[2] / 7.0];
    let moved = plus - x * LAMP[0] - y * LAMP[1] - z * LAMP[2];
    Number::Vec4([x as f32, y as f32, z as f32, moved as f32])
}

/// The depth is 0 at the near plane and 1 at the far one.
const DEPTH: f64 = FAR / (FAR - NEAR);

pub const UNIFORMS: &[(&str, Number)] = &[
    ("x", row(0, 1.0 / TANGENT, 0.0)),
    ("y", row(1, 1.0 / TANGENT, 0.0)),
    ("z", row(2, DEPTH, -DEPTH * NEAR)),
    ("w", row(2, 1.0, 0.0)),
    ("lamp", Number::Vec3([LAMP[0] as f32, LAMP[1] as f32, LAMP[2] as f32])),
];

/// Draws what the effect `midpoint` returns for the lamp.
pub fn map(solids: &Solids) -> Texels {
    let [columns, rows] = MAP;
    let texel = |(column, row): (u32, u32)| match midpoint(solids, [column.into(), row.into()]) {
        Some(depth) => [(1.0 - depth) as f32, 0.0, 0.0, 1.0],
        None => [0.0; 4],
    };
    let texels = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    Texels { size: [columns, rows, 1], values: texels.map(texel).collect() }
}

/// Returns the colour of a pixel; `None`: a comparison is too close.
pub fn midpoint_shadows(ray: &Ray<'_>) -> Option<[f64; 4]> {
    let hit = &ray.hits[0];
    let point = ray.position(hit.depth);
    let lit = lit(ray, hit, point)?;
    let normal = hit.triangle.normal;
    let direct = 0.8 * lit * dot(normal, unit(sub(LAMP, point))).max(0.0);
    let light = 0.2 + 0.12 * dot(normal, [-0.48, 0.8, 0.36]) + direct;
    let [r, g, b] = color(hit).map(|channel| light * channel);
    Some([r, g, b, 1.0])
}

/// Returns the part of a square of three by three texels around a point that the lamp lights.
fn lit(ray: &Ray<'_>, hit: &Hit<'_>, point: [f64; 3]) -> Option<f64> {
    let [x, y, far] = AXES.map(|axis| dot(scale(axis, 1.0 / 7.0), sub(point, LAMP)));
    let depth = depth(far);
    let [columns, rows] = MAP.map(f64::from);
    let (column, row) = (columns * (0.5 + 0.5 * x / far / TANGENT), rows * (0.5 - 0.5 * y / far / TANGENT));
    // The part of a texel, from `at` to `at + 1`, that is within the square.
    let share = |at: f64, centre: f64| ((at + 1.0).min(centre + 1.5) - at.max(centre - 1.5)).max(0.0);
    let (mut lit, mut least, mut most) = (0.0, true, false);
    for at_row in (0..5).map(|index| row.floor() - 2.0 + f64::from(index)) {
        for at_column in (0..5).map(|index| column.floor() - 2.0 + f64::from(index)) {
            let part = share(at_column, column) * share(at_row, row) / 9.0;
            if part < 1e-4 {
                continue;
            }
            let is_lit = match midpoint(ray.solids, [at_column, at_row]) {
                None => true,
                Some(middle) if (middle - depth).abs() < NEARLY => return None,
                Some(middle) => depth <= middle,
            };
            lit += if is_lit { part } else { 0.0 };
            (least, most) = (least && is_lit, most || is_lit);
        }
    }
    // Where all texels are alike, they are as the ray from the point to the lamp: it passes a surface, or none.
    if least == most && dot(hit.triangle.normal, sub(LAMP, point)) > 0.0 {
        let passed = distances(ray.solids, sub(point, LAMP)).into_iter().filter(|distance| *distance < 1.0 - NEARLY);
        assert_eq!(passed.count() == 0, least, "pixel with the point {point:?}");
    }
    Some(lit)
}

/// Returns the mean depth of the two nearest surfaces at a texel of the map; that of the far plane stands for a second surface.
fn midpoint(solids: &Solids, [column, row]: [f64; 2]) -> Option<f64> {
    let [columns, rows] = MAP.map(f64::from);
    let along = |at: f64, count: f64| TANGENT * (2.0 * (at.clamp(0.0, count - 1.0) + 0.5) / count - 1.0);
    let (x, y) = (along(column, columns), -along(row, rows));
    let [right, up, forward] = AXES.map(|axis| scale(axis, 1.0 / 7.0));
    let direction = std::array::from_fn(|i| forward[i] + x * right[i] + y * up[i]);
    let mut depths = distances(solids, direction).into_iter().map(depth).chain([1.0]);
    let first = depths.next().filter(|depth| *depth < 1.0)?;
    depths.next().map(|second| (first + second) / 2.0)
}

/// Returns the depth of a distance along the axis of the lamp.
fn depth(far: f64) -> f64 {
    DEPTH * (1.0 - NEAR / far)
}

/// Returns the distances at which a ray from the lamp passes triangles, in lengths of its direction, from the least.
fn distances(solids: &Solids, direction: [f64; 3]) -> Vec<f64> {
    let mut distances: Vec<f64> =
        solids.triangles.iter().filter_map(|triangle| distance(triangle, direction)).collect();
    distances.sort_by(f64::total_cmp);
    distances
}

/// Intersects a ray and a triangle (Möller and Trumbore 1997).
fn distance(triangle: &Triangle, direction: [f64; 3]) -> Option<f64> {
    let [a, b, c] = triangle.corners;
    let (first, second, from) = (sub(b, a), sub(c, a), sub(LAMP, a));
    let across = cross(direction, second);
    let determinant = dot(first, across);
    let u = dot(from, across) / determinant;
    let v = dot(direction, cross(from, first)) / determinant;
    let distance = dot(second, cross(from, first)) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}
