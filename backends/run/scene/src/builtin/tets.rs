//! A tetrahedral mesh of a ball or a torus, with a scalar at its points: a sum of Gaussian functions.
//!
//! A grid of cubes is jittered and divided, six tetrahedra per cube, and mapped to the body. Its diagonals are those of the neighbours, so that
//! tetrahedra share whole faces.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::random::Rng;
use super::row::{Attribute, Objects, Parameter, Row, SEED, hue, value};
use crate::limits::Budget;
use crate::tetrahedra::{faces, gradients, vertices};
use crate::{Limits, Object};

pub(super) const ROW: Row = Row {
    name: "tets",
    summary: "the faces of a tetrahedral mesh with a scalar; hole=0 is a ball, hole=1 a torus",
    parameters: &[
        Parameter { name: "n", default: 12, range: (1, 96) },
        Parameter { name: "hole", default: 1, range: (0, 1) },
        SEED,
    ],
    attributes: &[
        Attribute { name: "scalar", components: 1, is_integer: false },
        Attribute { name: "scalar_gradient", components: 3, is_integer: false },
        Attribute { name: "boundary", components: 1, is_integer: true },
    ],
    working,
    generate,
};

/// The bytes of a point and of a tetrahedron while the scene is generated.
const POINT: u64 = 4 * 24 + 16;
const TETRAHEDRON: u64 = 2 * 16 + 4 * (16 + 1) + 2 * (24 + 12);

fn working(values: &[u32]) -> u64 {
    let [x, y, z] = Grid::new(value(values, 0) as usize, value(values, 1) > 0).cubes.map(|side| side as u64);
    (x + 1) * (y + 1) * (z + 1) * POINT + 6 * x * y * z * TETRAHEDRON
}

/// The distance by which a point inside is moved, at most, relative to a cube.
const JITTER: f32 = 0.2;

/// The number of Gaussian functions, and their widths.
const BLOBS: usize = 6;
const WIDTHS: [f32; 2] = [0.16, 0.4];

/// The alpha of a face on the surface, and inside.
const ALPHAS: [f32; 2] = [0.25, 0.06];

/// The radii of the torus.
const RADII: [f64; 2] = [0.68, 0.32];

fn generate(values: &[u32]) -> Objects {
    let (n, is_torus, mut rng) = (value(values, 0) as usize, value(values, 1) > 0, Rng::seeded(value(values, 2)));
    Box::new(std::iter::once_with(move || {
        let grid = Grid::new(n, is_torus);
        let points = grid.points(&mut rng);
        let blobs = Blobs::new(&points, &mut rng);
        let scalars = blobs.at(&points);
        object(&points, &grid.tetrahedra(), &scalars)
    }))
}

/// The cubes before they are mapped: of the torus, the last axis is the angle around the hole.
struct Grid {
    cubes: [usize; 3],
    is_torus: bool,
}

impl Grid {
    fn new(n: usize, is_torus: bool) -> Self {
        // Around the hole, cubes are about as long as they are wide.
        Grid { cubes: if is_torus { [n, n, (3 * n).max(6)] } else { [n; 3] }, is_torus }
    }

    /// Returns the number of points along each axis. The angle has no end.
    fn sides(&self) -> [usize; 3] {
        let [x, y, z] = self.cubes;
        [x + 1, y + 1, if self.is_torus { z } else { z + 1 }]
    }

    fn points(&self, rng: &mut Rng) -> Vec<[f64; 3]> {
        let [width, height, depth] = self.sides();
        let mut points = Vec::with_capacity(width * height * depth);
        for at in 0..width * height * depth {
            let cell = [at % width, at / width % height, at / (width * height)];
            let axes = || cell.into_iter().zip(self.cubes).enumerate();
            // Near the surface the tetrahedra are flat, and a moved point could turn them inside out.
            let is_inside =
                axes().all(|(axis, (at, cubes))| (self.is_torus && axis == 2) || (at > 1 && at + 1 < cubes));
            let mut jittered = [0.0; 3];
            for (value, (_, (at, cubes))) in jittered.iter_mut().zip(axes()) {
                let offset = f64::from(rng.between(-JITTER, JITTER));
                *value = 2.0 * (at as f64 + if is_inside { offset } else { 0.0 }) / cubes as f64 - 1.0;
            }
            points.push(self.mapped(jittered).to_array());
        }
        points
    }

    /// Maps a cube to a ball, or its last axis to the angle around the hole of a torus.
    fn mapped(&self, [x, y, z]: [f64; 3]) -> DVec3 {
        let [xx, yy, zz] = [x * x, y * y, z * z];
        if !self.is_torus {
            let scale = |a: f64, b: f64| (1.0 - 0.5 * (a + b) + a * b / 3.0).sqrt();
            return DVec3::new(x * scale(yy, zz), y * scale(zz, xx), z * scale(xx, yy));
        }
        let disc = RADII[1] * DVec2::new(x * (1.0 - 0.5 * yy).sqrt(), y * (1.0 - 0.5 * xx).sqrt());
        let (sine, cosine) = (0.5 * TAU * z).sin_cos();
        let radius = RADII[0] + disc.x;
        DVec3::new(radius * cosine, disc.y, radius * sine)
    }

    /// Returns the tetrahedra: along the edges of a cube there are six ways from its first point to its last.
    fn tetrahedra(&self) -> Vec<[u32; 4]> {
        const WAYS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let ([width, height, depth], [across, up, along]) = (self.sides(), self.cubes);
        let index = |[x, y, z]: [usize; 3]| (x + width * (y + height * (z % depth))) as u32;
        let mut tetrahedra = Vec::with_capacity(6 * across * up * along);
        for cube in 0..across * up * along {
            let first = [cube % across, cube / across % up, cube / (across * up)];
            for way in WAYS {
                let mut at = first;
                let mut corners = [index(at); 4];
                for (corner, axis) in corners.iter_mut().skip(1).zip(way) {
                    at = std::array::from_fn(|other| at[other] + usize::from(other == axis));
                    *corner = index(at);
                }
                tetrahedra.push(corners);
            }
        }
        tetrahedra
    }
}

/// Gaussian functions: centre, width and height.
struct Blobs(Vec<(DVec3, f64, f64)>);

impl Blobs {
    /// Returns functions around points of the mesh.
    fn new(points: &[[f64; 3]], rng: &mut Rng) -> Self {
        let blob = |_| {
            let at = (rng.unit() * points.len() as f32) as usize;
            let centre = points.get(at).copied().unwrap_or_default();
            (DVec3::from(centre), f64::from(rng.between(WIDTHS[0], WIDTHS[1])), f64::from(rng.between(0.5, 1.0)))
        };
        Blobs((0..BLOBS).map(blob).collect())
    }

    /// Returns the sum at each point, from 0 to 1.
    fn at(&self, points: &[[f64; 3]]) -> Vec<f64> {
        let sum = |point: &[f64; 3]| {
            let one = |(centre, width, height): &(DVec3, f64, f64)| {
                let distance = (DVec3::from(*point) - *centre).length_squared();
                height * (-distance / (width * width)).exp()
            };
            self.0.iter().map(one).sum::<f64>()
        };
        let sums: Vec<f64> = points.iter().map(sum).collect();
        let greatest = sums.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        sums.into_iter().map(|sum| sum / greatest).collect()
    }
}

/// Returns the faces as an object with the attributes of the row.
fn object(points: &[[f64; 3]], tetrahedra: &[[u32; 4]], scalars: &[f64]) -> Object {
    // The memory is taken before, as `working`.
    let budget = Budget::new(&Limits { memory: u64::MAX, reads_named_files: false });
    let Ok(faces) = faces(points, tetrahedra, &budget) else { return Object::default() };
    let Ok((corners, triangles)) = vertices(points.len(), &faces, false, &budget) else { return Object::default() };
    let gradients = gradients(points, tetrahedra, scalars);
    let mut object =
        Object { name: "mesh".to_owned(), attributes: vec![Vec::new(); 3], triangles, ..Object::default() };
    for corner in corners {
        let (at, is_boundary) = (corner.point as usize, corner.face.is_boundary);
        let (position, scalar) =
            (points.get(at).copied().unwrap_or_default(), scalars.get(at).copied().unwrap_or_default());
        let alpha = if is_boundary { ALPHAS[0] } else { ALPHAS[1] };
        object.vertex(position.map(|axis| axis as f32), [0.0; 3], hue(0.66 - 0.6 * scalar as f32, alpha));
        let gradient = gradients.get(at).copied().unwrap_or_default();
        let words = [
            vec![(scalar as f32).to_bits()],
            gradient.map(|axis| (axis as f32).to_bits()).to_vec(),
            vec![u32::from(is_boundary)],
        ];
        for (list, words) in object.attributes.iter_mut().zip(words) {
            list.extend(words);
        }
    }
    crate::normals::complete(&mut object);
    object
}

#[cfg(test)]
mod tests {
    use super::Grid;
    use crate::builtin::random::Rng;
    use crate::tetrahedra::volume;

    /// No tetrahedron is turned inside out, so they do not overlap, and together they are the body.
    #[test]
    fn tetrahedra_have_positive_volumes() {
        for (n, is_torus, body) in
            [(1, false, 0.0), (5, false, 4.19), (12, false, 4.19), (2, true, 0.0), (12, true, 1.37)]
        {
            for seed in 1..4 {
                let grid = Grid::new(n, is_torus);
                let points = grid.points(&mut Rng::seeded(seed));
                let tetrahedra = grid.tetrahedra();
                let volumes: Vec<f64> =
                    tetrahedra.iter().map(|corners| volume(&points, *corners).abs() / 6.0).collect();
                let signed: Vec<f64> = tetrahedra.iter().map(|corners| volume(&points, *corners)).collect();
                // Three of the six ways along the axes turn left, three right.
                let turns = [1.0, -1.0, -1.0, 1.0, 1.0, -1.0];
                let sign = signed[0].signum();
                for (way, volume) in signed.iter().enumerate() {
                    assert!(volume * sign * turns[way % 6] > 0.0, "n={n}, seed={seed}: tetrahedron {way}: {volume}");
                }
                let sum: f64 = volumes.iter().sum();
                assert!(body == 0.0 || (0.9..1.0).contains(&(sum / body)), "n={n}: {sum}, not {body}");
            }
        }
    }
}
