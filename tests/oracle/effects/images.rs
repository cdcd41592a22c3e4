//! References of effects that read other pixels: B06 sections 4.1 and 4.2.

use super::layers::{CAMERA, color, surface};
use super::ray::{Hit, Ray};
use super::solids::{cross, dot, scale, sub, unit};

/// The second difference of distances from which a line is drawn.
pub const JUMP: f32 = 0.05;

/// The distances at which the midground begins and ends.
pub const NEAR: f32 = 3.3;
pub const FAR: f32 = 3.5;

/// Lines at second differences of the distance, over surfaces that are lit by normals of central differences.
pub fn silhouettes(ray: &Ray<'_>) -> Option<[f64; 4]> {
    let nearest = |offset| {
        let ray = ray.neighbour(offset)?;
        Some(ray.hits.first().map_or([0.0; 4], |hit| {
            let [x, y, z] = ray.position(hit.depth);
            [x, y, z, distance(&ray, hit)]
        }))
    };
    let [left, right, above, below] = [nearest([-1, 0])?, nearest([1, 0])?, nearest([0, -1])?, nearest([0, 1])?];
    let here = distance(ray, &ray.hits[0]);
    let bends = [[left, right], [above, below]].map(|[one, other]| (one[3] - here) + (other[3] - here));
    let is_line = bends.iter().any(|bend| bend.abs() > f64::from(JUMP));
    // A device and the reference may round to different sides.
    if bends.iter().any(|bend| (bend.abs() - f64::from(JUMP)).abs() < 1e-4) {
        return None;
    }
    if is_line {
        return Some([0.0, 0.0, 0.0, 1.0]);
    }
    let difference = |one: [f64; 4], other: [f64; 4]| sub([one[0], one[1], one[2]], [other[0], other[1], other[2]]);
    let normal = unit(cross(difference(right, left), difference(above, below)));
    let to_camera = sub(CAMERA.map(f64::from), ray.position(ray.hits[0].depth));
    let normal = if dot(normal, to_camera) < 0.0 { scale(normal, -1.0) } else { normal };
    let key = 0.75 * dot(normal, [0.48, 0.8, 0.36]).max(0.0);
    let fill = 0.35 * dot(normal, [-0.8, 0.0, 0.6]).max(0.0);
    let [r, g, b] = scale(color(&ray.hits[0]), 0.2 + key + fill);
    Some([r, g, b, 1.0])
}

/// The nearest surface of each of three parts of the ray: the first and the last are means over a square of pixels.
pub fn depth_of_field(ray: &Ray<'_>) -> Option<[f64; 4]> {
    let (near, far) = (f64::from(NEAR), f64::from(FAR));
    let mut means = [[0.0; 4]; 2];
    for offset in (-4..=4).flat_map(|y| (-4..=4).map(move |x| [2 * x, 2 * y])) {
        let other = ray.neighbour(offset)?;
        // The foreground hides everything else: it counts if it is the nearest surface.
        let foreground = other.hits.first().filter(|hit| distance(&other, hit) < near);
        let background = other.hits.iter().find(|hit| distance(&other, hit) > far);
        for (mean, hit) in means.iter_mut().zip([foreground, background]) {
            let [r, g, b] = hit.map_or([0.0; 3], surface);
            let opaque = if hit.is_some() { 1.0 } else { 0.0 };
            *mean = std::array::from_fn(|channel| mean[channel] + [r, g, b, opaque][channel] / 81.0);
        }
    }
    let midground = ray.hits.iter().find(|hit| (near..=far).contains(&distance(ray, hit)));
    let [foreground, background] = means;
    let [r, g, b] = midground.map_or([0.0; 3], surface);
    let behind = if midground.is_some() { [r, g, b, 1.0] } else { background };
    Some(std::array::from_fn(|channel| foreground[channel] + (1.0 - foreground[3]) * behind[channel]))
}

/// Returns the distance of a hit from the camera.
fn distance(ray: &Ray<'_>, hit: &Hit<'_>) -> f64 {
    let to_camera = sub(CAMERA.map(f64::from), ray.position(hit.depth));
    dot(to_camera, to_camera).sqrt()
}
