//! Parallel layers of strips, oblique to the view from the front. Most strips are divided into cells, some are one pair of long and thin triangles,
//! whose centroids say little about the depths of their fragments. No triangles intersect, so an order of small ones is the order of their
//! fragments: the scene of experiments with centroid sorting and subdivision, in place of the tetrahedral mesh with badly formed primitives of
//! Bavoil et al. 2006 (B06, section 5).

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "slivers",
    summary: "n oblique layers of strips, which are divided into cells; so many per cent of them are two long and thin triangles",
    parameters: &[
        Parameter { name: "n", default: 16, range: (1, 1024) },
        SEED,
        Parameter { name: "rows", default: 24, range: (1, 1024) },
        Parameter { name: "long", default: 10, range: (0, 100) },
    ],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The part of a row that its strip covers: strips have no common edges.
const COVERED: f32 = 0.9;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    let [layers, rows, long] = [0, 2, 3].map(|index| value(values, index));
    Box::new((0..layers).map(move |index| {
        let mut object = Object { name: format!("layer {index}"), ..Object::default() };
        // Layers keep their order, at different distances.
        let offset = (index as f32 + rng.between(0.0, 0.6)) / layers as f32 - 0.5;
        for row in 0..rows {
            let cells = if rng.unit() * 100.0 < long as f32 { 1 } else { rows };
            let height = 2.0 / rows as f32;
            let bottom = row as f32 * height - 1.0;
            strip(&mut object, ([bottom, bottom + COVERED * height], offset), cells, &mut rng);
        }
        object
    }))
}

/// Adds a strip of so many cells, each of two triangles, in the plane z = x + offset.
fn strip(object: &mut Object, ([bottom, top], offset): ([f32; 2], f32), cells: u32, rng: &mut Rng) {
    const NORMAL: [f32; 3] = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, std::f32::consts::FRAC_1_SQRT_2];
    let color = hue(rng.unit(), rng.between(0.05, 0.2));
    for edge in 0..=cells {
        let x = 2.0 * edge as f32 / cells as f32 - 1.0;
        let [a, b] = [bottom, top].map(|y| object.vertex([x, y, x + offset], NORMAL, color));
        if let Some(left) = a.checked_sub(2).filter(|_| edge > 0) {
            object.polygon(&[left, a, b, left + 1]);
        }
    }
}
