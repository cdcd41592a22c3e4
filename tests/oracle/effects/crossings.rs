//! References of effects that depend on the insides of solids: B06 section 4.1, D13 section 4. Each part of a ray is tested at its middle.

use super::layers::{ALPHA, color, lit, painted, surface};
use super::ray::{Hit, Ray};
use super::solids::{dot, scale};

/// The first two solids without those of the ids up to 31.
pub fn csg(ray: &Ray<'_>) -> [f64; 4] {
    first_surface(ray, |span| {
        let is_inside = |id: u32| ray.containing(span, |other| other == id) > 0;
        (is_inside(0) || is_inside(1)) && (2..32).all(|id| !is_inside(id))
    })
}

/// Points that an odd number of solids contains.
pub fn self_trimmed(ray: &Ray<'_>) -> [f64; 4] {
    first_surface(ray, |span| ray.containing(span, |_| true) % 2 == 1)
}

/// The surface before the first part that is solid, with its side to the camera lit.
fn first_surface(ray: &Ray<'_>, is_solid: impl Fn(&super::ray::Span) -> bool) -> [f64; 4] {
    let Some(span) = ray.spans().into_iter().find(is_solid) else { return [0.0; 4] };
    let seen = ray.at(span.from).max_by_key(|hit| hit.triangle.id).unwrap();
    // The camera looks along z.
    let side = if seen.triangle.normal[2] > 0.0 { -1.0 } else { 1.0 };
    let normal = scale(seen.triangle.normal, side);
    let key = dot(normal, [0.48, 0.8, 0.36]).max(0.0);
    let fill = dot(normal, [-0.8, 0.0, 0.6]).max(0.0);
    let [r, g, b] = color(seen);
    let light = |tint: f64| 0.2 + 0.75 * key + 0.35 * tint * fill;
    [r * light(0.7), g * light(0.85), b * light(1.0), 1.0]
}

/// Surfaces up to the first part that two solids contain, before which a red surface is opaque.
pub fn self_collision(ray: &Ray<'_>) -> [f64; 4] {
    let collision = ray.spans().into_iter().find(|span| ray.containing(span, |_| true) > 1);
    let end = collision.map_or(f64::INFINITY, |span| span.from);
    let outside = |hit: &&Hit<'_>| hit.depth < end;
    let mut layers: Vec<([f64; 3], f64)> =
        ray.hits.iter().filter(outside).map(|hit| (surface(hit), f64::from(ALPHA))).collect();
    let mut last: Vec<&Hit<'_>> = ray.at(end).collect();
    last.sort_by_key(|hit| hit.triangle.id);
    if let Some(red) = last.pop() {
        layers.extend(last.iter().map(|hit| (surface(hit), f64::from(ALPHA))));
        layers.push((scale([0.9, 0.02, 0.02], lit(red)), 1.0));
    }
    painted(layers.into_iter())
}

/// The colour of the greatest number of solids that contain a point of the ray.
pub fn winding_number(ray: &Ray<'_>) -> [f64; 4] {
    let greatest = ray.spans().iter().map(|span| ray.containing(span, |_| true)).max().unwrap();
    let color = match greatest {
        0 => [0.3, 0.3, 0.3],
        1 => [0.04, 0.6, 0.9],
        2 => [0.04, 1.0, 0.04],
        3 => [1.0, 1.0, 0.04],
        4 => [1.0, 0.6, 0.04],
        _ => [1.0, 0.2, 0.04],
    };
    let light = 0.45 + 0.55 * dot(ray.hits[0].triangle.normal, [0.48, 0.8, 0.36]).abs();
    let [r, g, b] = scale(color, light);
    [r, g, b, 1.0]
}
