//! References of effects that show numbers as colours: D13 Fig. 13, depth complexity, and the midpoints of Woo 1992.

use super::ray::Ray;
use super::solids::{dot, scale};

pub const MOST: f32 = 9.0;
pub const NEAR: f32 = 0.125;
pub const FAR: f32 = 0.875;

/// The colours of D13, Fig. 13, by the least number of fragments that share a depth, in sRGB.
const COPLANAR: [(usize, [u8; 3]); 9] = [
    (0, [0x80, 0x80, 0x80]),
    (2, [0xff, 0x00, 0x00]),
    (3, [0x00, 0x00, 0xff]),
    (4, [0x00, 0x80, 0x00]),
    (5, [0x00, 0xff, 0xff]),
    (6, [0x7f, 0xff, 0xd4]),
    (7, [0xff, 0x00, 0xff]),
    (8, [0xff, 0xff, 0x00]),
    (9, [0xa5, 0x2a, 0x2a]),
];

pub fn coplanarity(ray: &Ray<'_>) -> [f64; 4] {
    let shared = ray.hits.iter().filter(|hit| ray.at(hit.depth).count() > 1).count();
    let (_, color) = COPLANAR.iter().rev().find(|(least, _)| *least <= shared).unwrap();
    let light = 0.4 + 0.6 * dot(ray.hits[0].triangle.normal, [0.48, 0.8, 0.36]).abs();
    let [r, g, b] = scale(color.map(linear), light);
    [r, g, b, 1.0]
}

/// Returns the linear value of a channel in sRGB (IEC 61966-2-1).
fn linear(channel: u8) -> f64 {
    let value = f64::from(channel) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Colours at equal distances of a piecewise linear scale.
const SCALE: [[f64; 3]; 4] = [[0.01, 0.005, 0.06], [0.25, 0.01, 0.2], [0.9, 0.15, 0.02], [1.0, 0.95, 0.55]];

pub fn complexity(ray: &Ray<'_>) -> [f64; 4] {
    let at = 3.0 * ((ray.hits.len() - 1) as f64 / f64::from(MOST - 1.0)).min(1.0);
    let first = (at.floor() as usize).min(SCALE.len() - 2);
    let part = at - first as f64;
    let [r, g, b] = std::array::from_fn(|i| (1.0 - part) * SCALE[first][i] + part * SCALE[first + 1][i]);
    [r, g, b, 1.0]
}

pub fn midpoint(ray: &Ray<'_>) -> [f64; 4] {
    let mut depths = ray.hits.iter().map(|hit| hit.depth).chain([1.0]);
    let mean = (depths.next().unwrap() + depths.next().unwrap()) / 2.0;
    let [near, far] = [NEAR, FAR].map(f64::from);
    let grey = 1.0 - ((mean - near) / (far - near)).clamp(0.0, 1.0);
    [grey, grey, grey, 1.0]
}
