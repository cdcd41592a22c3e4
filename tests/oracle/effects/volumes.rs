//! References of effects of tetrahedral meshes: B06 section 4.3. The scalar is linear between two faces.

use super::Texels;
use super::layers::{ALPHA, painted};
use super::ray::{Hit, Ray};
use super::solids::{Solids, dot, gradient, scalar};

/// The extinction of the scalar 1.
pub const DENSITY: f32 = 6.0;

/// The scalar of the surface.
pub const VALUE: f32 = 0.55;

/// The steps of a numerical integral over a part of a ray.
const STEPS: usize = 400;

/// The extinction of the table where its transfer function has the alpha 1, and the length of its last slice.
const EXTINCTION: f64 = 8.0;
pub const LENGTH: f32 = 0.6;

/// The scalars and lengths of the table, and the steps of its integrals.
const TABLE: [u32; 3] = [65, 65, 65];
const TABLE_STEPS: usize = 32;

/// Computes the table: light by the scalars at both ends and the length between them.
pub fn table(_: &Solids) -> Texels {
    let share = |index: u32, axis: usize| f64::from(index) / f64::from(TABLE[axis] - 1);
    let texel = |index: u32| {
        let [column, row, slice] = [index % TABLE[0], index / TABLE[0] % TABLE[1], index / TABLE[0] / TABLE[1]];
        let scalars = [share(column, 0), share(row, 1)];
        let mut light = Light::default();
        light.pass(scalars, share(slice, 2) * f64::from(LENGTH), TABLE_STEPS);
        light.premultiplied().map(|channel| channel as f32)
    };
    Texels { size: TABLE, values: (0..TABLE[0] * TABLE[1] * TABLE[2]).map(texel).collect() }
}

/// Light of the whole ray, by small steps through all of its parts.
pub fn volume_table(ray: &Ray<'_>) -> [f64; 4] {
    let mut light = Light::default();
    for [front, back] in parts(ray) {
        let length = back.depth - front.depth;
        assert!(length < f64::from(LENGTH), "the table ends at {LENGTH}");
        light.pass([front, back].map(|hit| scalar_of(ray, hit)), length, STEPS);
    }
    light.premultiplied()
}

/// Light that reaches the front of a ray.
struct Light {
    color: [f64; 3],
    transmittance: f64,
}

impl Default for Light {
    fn default() -> Self {
        Light { color: [0.0; 3], transmittance: 1.0 }
    }
}

impl Light {
    /// Continues through a part in which the scalar is linear. The medium is most opaque at 0.5, and its colour goes from blue to red.
    fn pass(&mut self, [from, to]: [f64; 2], length: f64, steps: usize) {
        for step in 0..steps {
            let s = from + (to - from) * (step as f64 + 0.5) / steps as f64;
            let passes = (-EXTINCTION * 4.0 * s * (1.0 - s) * length / steps as f64).exp();
            let emitted = [s, 0.4, 1.0 - s];
            self.color = std::array::from_fn(|i| self.color[i] + self.transmittance * (1.0 - passes) * emitted[i]);
            self.transmittance *= passes;
        }
    }

    fn premultiplied(&self) -> [f64; 4] {
        let [r, g, b] = self.color;
        [r, g, b, 1.0 - self.transmittance]
    }
}

/// Light that each part emits and absorbs, by sums over small steps. Within a part, its light has one colour.
pub fn volume(ray: &Ray<'_>) -> [f64; 4] {
    painted(parts(ray).map(|[front, back]| {
        let [from, to] = [front, back].map(|hit| scalar_of(ray, hit));
        let step = (back.depth - front.depth) / STEPS as f64;
        let scalars = (0..STEPS).map(|at| from + (to - from) * (at as f64 + 0.5) / STEPS as f64);
        let (mut depth, mut warm) = (0.0, 0.0);
        for s in scalars {
            depth += s * s * step;
            warm += s * s * s * step;
        }
        let warm = warm / depth;
        let mix = |cold: f64, hot: f64| (1.0 - warm) * cold + warm * hot;
        ([mix(0.02, 1.0), mix(0.12, 0.3), mix(0.6, 0.03)], 1.0 - (-f64::from(DENSITY) * depth).exp())
    }))
}

/// A surface at each part whose scalars are on both sides of the value.
pub fn isosurface(ray: &Ray<'_>) -> [f64; 4] {
    painted(parts(ray).filter_map(|[front, back]| {
        let [from, to] = [front, back].map(|hit| scalar_of(ray, hit));
        let at = (f64::from(VALUE) - from) / (to - from);
        if !(0.0..=1.0).contains(&at) {
            return None;
        }
        let [one, other] = [front, back].map(|hit| hit.interpolated(ray.position(hit.depth), gradient));
        let gradient: [f64; 3] = std::array::from_fn(|i| one[i] + at * (other[i] - one[i]));
        let length = dot(gradient, gradient).sqrt();
        let lamp = |direction: [f64; 3], strength: f64| strength * dot(gradient, direction).abs() / length;
        let light = 0.25 + lamp([0.48, 0.8, 0.36], 0.6) + lamp([-0.8, 0.0, 0.6], 0.3);
        let color = if to > from { [0.95, 0.4, 0.08] } else { [0.1, 0.3, 0.8] };
        Some((color.map(|channel| light * channel), f64::from(ALPHA)))
    }))
}

/// Returns the parts of a ray within a solid, by the faces around them.
fn parts<'r>(ray: &'r Ray<'_>) -> impl DoubleEndedIterator<Item = [&'r Hit<'r>; 2]> {
    let pairs: Vec<[&Hit<'_>; 2]> = ray.hits.windows(2).map(|pair| [&pair[0], &pair[1]]).collect();
    pairs.into_iter().filter(|[front, back]| ray.is_inside(0.5 * (front.depth + back.depth)))
}

fn scalar_of(ray: &Ray<'_>, hit: &Hit<'_>) -> f64 {
    hit.interpolated(ray.position(hit.depth), |corner| [scalar(corner)])[0]
}
