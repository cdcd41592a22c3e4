//! The reference of surfaces of particles: B06 section 4.3. Fields are summed at points of the ray, and particles there are found by solid angles.

use super::ray::{Ray, Span};
use super::solids::{BALLS, dot, scale, sub, unit};

/// The field at the surface.
pub const VALUE: f32 = 0.8;

/// Fields that differ by less may be on another side of the value on a device.
const NEARLY: f64 = 2e-3;

/// The steps through a part of a ray.
const STEPS: u32 = 500;

/// Returns the colour of the first point with the value; `None`: the ray touches the surface.
pub fn particles(ray: &Ray<'_>) -> Option<[f64; 4]> {
    for span in ray.spans() {
        let around: Vec<u32> =
            (0..BALLS.len() as u32).filter(|id| ray.containing(&span, |other| other == *id) > 0).collect();
        let sum = |depth: f64| around.iter().map(|id| field(*id, ray.position(depth))).sum::<f64>() - f64::from(VALUE);
        let at = |step: u32| span.from + (span.to - span.from) * f64::from(step) / f64::from(STEPS);
        let first = (0..=STEPS).find(|step| sum(at(*step)) >= 0.0);
        let most = (0..=STEPS).map(|step| sum(at(step))).fold(f64::NEG_INFINITY, f64::max);
        if most.abs() < NEARLY || sum(span.from).abs() < NEARLY {
            return None;
        }
        if let Some(step) = first {
            let depth = if step == 0 { span.from } else { root(&sum, Span { from: at(step - 1), to: at(step) }) };
            return Some(lit(&around, ray.position(depth)));
        }
    }
    Some([0.0; 4])
}

/// Bisects to where a sum becomes positive.
fn root(sum: &impl Fn(f64) -> f64, mut span: Span) -> f64 {
    for _ in 0..40 {
        let middle = 0.5 * (span.from + span.to);
        if sum(middle) < 0.0 { span.from = middle } else { span.to = middle }
    }
    span.to
}

/// Returns the field of a particle: 1 at its centre, 0 at its radius.
fn field(id: u32, point: [f64; 3]) -> f64 {
    let (centre, radius, _) = BALLS[id as usize];
    let offset = sub(point, centre);
    1.0 - dot(offset, offset) / (radius * radius)
}

/// Returns the colour of a point, by the fields of the particles around it and by differences of their sum.
fn lit(around: &[u32], point: [f64; 3]) -> [f64; 4] {
    let sum = |point: [f64; 3]| around.iter().map(|id| field(*id, point)).sum::<f64>();
    let slope = |axis: usize| {
        let moved = |by: f64| std::array::from_fn(|i| point[i] + if i == axis { by } else { 0.0 });
        sum(moved(-1e-4)) - sum(moved(1e-4))
    };
    let normal = unit([0, 1, 2].map(slope));
    let lamp = |direction: [f64; 3], strength: f64| strength * dot(normal, direction).max(0.0);
    let light = 0.2 + lamp([0.48, 0.8, 0.36], 0.7) + lamp([-0.8, 0.0, 0.6], 0.25);
    let colors = around
        .iter()
        .map(|id| scale(BALLS[*id as usize].2.map(|channel| f64::from(channel) / 255.0), field(*id, point)));
    let [r, g, b] = colors.fold([0.0; 3], |sum: [f64; 3], color| std::array::from_fn(|i| sum[i] + color[i]));
    let [r, g, b] = scale([r, g, b], light / sum(point));
    [r, g, b, 1.0]
}
