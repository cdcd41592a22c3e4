//! Quads over the whole frame, each a tilted plane at a random depth, so that the order of depths differs between pixels: the scene of
//! the measurements of Vasilakis et al. 2015 (K15, section 5.1), where every pixel has n fragments in random order. They are within clip
//! space: `--camera clip` shows n fragments in every pixel.
//!
//! With `pixels` or `fragments` below 100 a layer is divided into cells. Only so many per cent of the cells are covered at all (the paper's p_d), and
//! a layer has each of these with a probability of so many per cent (f_p).
//!
//! With `coplanar` above 1 every plane has so many quads, whose fragments have equal depths (Vasilakis & Fudos 2013, section 4.1.2).

use super::random::Rng;
use super::row::{Objects, Parameter, Row, SEED, hue, no_memory, value};
use crate::Object;

pub(super) const ROW: Row = Row {
    name: "layers",
    summary: "n tilted quads over the whole frame, in random order of depth (with --camera clip); in per cent: covered pixels, and fragments of these; quads of each plane, which have equal depths",
    parameters: &[
        Parameter { name: "n", default: 16, range: (1, 65_536) },
        SEED,
        Parameter { name: "pixels", default: 100, range: (1, 100) },
        Parameter { name: "fragments", default: 100, range: (1, 100) },
        Parameter { name: "coplanar", default: 1, range: (1, 256) },
    ],
    attributes: &[],
    working: no_memory,
    generate,
};

/// The greatest distance of a corner's depth from that of the centre.
const TILT: f32 = 0.2;

/// The cells along a side of a divided layer.
const CELLS: usize = 8;

fn generate(values: &[u32]) -> Objects {
    let mut rng = Rng::seeded(value(values, 1));
    let [pixels, fragments] = [2, 3].map(|index| value(values, index));
    let covered = (pixels.min(fragments) < 100).then(|| covered(pixels, &mut rng));
    let coplanar = value(values, 4);
    let mut plane = None;
    Box::new((0..value(values, 0).saturating_mul(coplanar)).map(move |index| {
        let mut layer = Layer::new(index, &mut rng, plane.filter(|_| index % coplanar != 0));
        plane = Some(layer.plane);
        match &covered {
            None => layer.quad([-1.0, -1.0], [1.0, 1.0]),
            Some(cells) => {
                for cell in cells {
                    if rng.unit() * 100.0 < fragments as f32 {
                        let [from, to] = [cell.map(edge), cell.map(|at| edge(at + 1))];
                        layer.quad(from, to);
                    }
                }
            }
        }
        layer.object
    }))
}

/// Returns this part of the cells, in per cent, by column and row.
fn covered(percent: u32, rng: &mut Rng) -> Vec<[usize; 2]> {
    let mut cells: Vec<[usize; 2]> = (0..CELLS * CELLS).map(|cell| [cell % CELLS, cell / CELLS]).collect();
    for at in (1..cells.len()).rev() {
        cells.swap(at, (rng.unit() * (at + 1) as f32) as usize % (at + 1));
    }
    cells.truncate((cells.len() * percent as usize).div_ceil(100));
    cells
}

/// Returns the coordinate at which a cell begins.
fn edge(cell: usize) -> f32 {
    2.0 * cell as f32 / CELLS as f32 - 1.0
}

/// A plane, and the quads that lie in it.
struct Layer {
    object: Object,
    plane: Plane,
    color: [f32; 4],
}

/// The depth at the centre, and how it changes along x and y.
#[derive(Clone, Copy)]
struct Plane {
    depth: f32,
    slopes: [f32; 2],
}

impl Layer {
    /// Makes a layer in a plane; in one of its own if there is none.
    fn new(index: u32, rng: &mut Rng, plane: Option<Plane>) -> Self {
        let object = Object { name: format!("layer {index}"), ..Object::default() };
        let plane = plane.unwrap_or_else(|| Plane {
            depth: rng.between(TILT, 1.0 - TILT),
            slopes: [(); 2].map(|()| rng.between(-0.5 * TILT, 0.5 * TILT)),
        });
        let color = hue(rng.unit(), rng.between(0.05, 0.2));
        Layer { object, plane, color }
    }

    /// Adds the part of the plane between two corners.
    fn quad(&mut self, from: [f32; 2], to: [f32; 2]) {
        let corners = [[from[0], from[1]], [to[0], from[1]], to, [from[0], to[1]]];
        let corners = corners.map(|[x, y]| {
            let depth = self.plane.depth + x * self.plane.slopes[0] + y * self.plane.slopes[1];
            self.object.vertex([x, y, depth], [0.0, 0.0, -1.0], self.color)
        });
        self.object.polygon(&corners);
    }
}
