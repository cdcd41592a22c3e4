//! References of effects that composite layers: B06 section 4.1.

use super::ray::{Hit, Ray};
use super::solids::{add, dot, scale, sub, unit};

pub const ALPHA: f32 = 0.375;

/// The width of lines, in the units of clip space.
pub const WIDTH: f32 = 0.15;

/// A point in front of the frame, from which angles are measured.
pub const CAMERA: [f32; 3] = [0.25, 0.5, -3.0];

pub const ABSORPTION: [f32; 3] = [0.5, 1.25, 3.0];

/// Directions and strengths of the lamps that light both sides, and the strength without them.
const AMBIENT: f64 = 0.2;
const LAMPS: [([f64; 3], f64); 2] = [([0.48, 0.8, 0.36], 0.6), ([-0.8, 0.0, 0.6], 0.3)];

/// Surfaces with lamps that they reflect, by the painter's algorithm: from the farthest, each over those behind it.
pub fn transparency(ray: &Ray<'_>) -> [f64; 4] {
    ray.hits.iter().rev().fold([0.0; 4], |behind, hit| {
        let normal = hit.triangle.normal;
        let to_camera = unit(sub(CAMERA.map(f64::from), ray.position(hit.depth)));
        // Blinn's exponent and strength.
        let shine = |lamp: [f64; 3]| 0.8 * dot(normal, unit(add(to_camera, lamp))).abs().powi(60);
        let [first, second] = LAMPS.map(|(lamp, _)| lamp);
        let diffuse = AMBIENT + 0.65 * dot(normal, first).abs() + 0.3 * dot(normal, second).abs();
        let specular = 0.65 * shine(first) + 0.3 * shine(second);
        let alpha = f64::from(ALPHA);
        let [r, g, b] = color(hit).map(|channel| alpha * diffuse * channel + specular);
        std::array::from_fn(|channel| [r, g, b, alpha][channel] + (1.0 - alpha) * behind[channel])
    })
}

/// Opaque lines where one of the edges of the triangle is near, over translucent surfaces.
pub fn wireframe(ray: &Ray<'_>) -> [f64; 4] {
    painted(ray.hits.iter().map(|hit| {
        let is_line = ray.edge_distance(hit) < 0.5 * f64::from(WIDTH);
        let part = if is_line { 0.25 } else { 1.0 };
        (scale(surface(hit), part), if is_line { 1.0 } else { f64::from(ALPHA) })
    }))
}

/// Composites straight colours from back to front. Input: from front to back.
pub fn painted(layers: impl DoubleEndedIterator<Item = ([f64; 3], f64)>) -> [f64; 4] {
    layers.rev().fold([0.0; 4], |behind, (color, alpha)| {
        let [r, g, b] = color;
        std::array::from_fn(|channel| alpha * [r, g, b, 1.0][channel] + (1.0 - alpha) * behind[channel])
    })
}

/// Returns the colour of a surface that both lamps light.
pub fn surface(hit: &Hit<'_>) -> [f64; 3] {
    scale(color(hit), lit(hit))
}

/// Returns the light on both sides of a surface.
pub fn lit(hit: &Hit<'_>) -> f64 {
    AMBIENT + LAMPS.iter().map(|(lamp, strength)| strength * dot(hit.triangle.normal, *lamp).abs()).sum::<f64>()
}

pub fn color(hit: &Hit<'_>) -> [f64; 3] {
    let [r, g, b, _] = hit.triangle.color.map(|channel| f64::from(channel) / 255.0);
    [r, g, b]
}

/// Light that the law of Beer and Lambert leaves over every part within solids, and Schlick's transmittance at every surface.
pub fn translucency(ray: &Ray<'_>) -> [f64; 4] {
    let camera = CAMERA.map(f64::from);
    let transmitted: f64 = ray
        .hits
        .iter()
        .map(|hit| {
            let to_camera = unit(sub(camera, ray.position(hit.depth)));
            let sine = 1.0 - dot(hit.triangle.normal, to_camera).abs();
            1.0 - sine.powi(5)
        })
        .product();
    let left = ray.spans().iter().fold([transmitted; 3], |light, span| {
        let is_inside = ray.containing(span, |_| true) > 0;
        let length = if is_inside { span.to - span.from } else { 0.0 };
        std::array::from_fn(|channel| light[channel] * (-f64::from(ABSORPTION[channel]) * length).exp())
    });
    [left[0], left[1], left[2], 1.0]
}
