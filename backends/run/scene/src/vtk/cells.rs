//! Divides the cells of a grid into tetrahedra.
//!
//! The rule of Dompierre et al. (1999, "How to subdivide pyramids, prisms, and hexahedra into tetrahedra"): all tetrahedra of a cell meet in its point
//! of the least number, and a face of four points is divided at its point of the least number. Neighbours divide a shared face equally.

use super::Grid;
use crate::error::{FileError, FilePosition};
use crate::limits::Budget;
use crate::warnings::{FileWarnings, Message, WarningKind};

/// A type of cells: its number in VTK, the points that it has at least, its faces, and whether further points curve it.
struct Shape {
    number: u8,
    points: usize,
    faces: &'static [&'static [usize]],
    is_curved: bool,
}

const TETRAHEDRON: &[&[usize]] = &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
const VOXEL: &[&[usize]] = &[&[0, 1, 3, 2], &[4, 5, 7, 6], &[0, 1, 5, 4], &[1, 3, 7, 5], &[3, 2, 6, 7], &[2, 0, 4, 6]];
const HEXAHEDRON: &[&[usize]] =
    &[&[0, 1, 2, 3], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const WEDGE: &[&[usize]] = &[&[0, 1, 2], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
const PYRAMID: &[&[usize]] = &[&[0, 1, 2, 3], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];

const SHAPES: [Shape; 9] = [
    Shape { number: 10, points: 4, faces: TETRAHEDRON, is_curved: false },
    Shape { number: 11, points: 8, faces: VOXEL, is_curved: false },
    Shape { number: 12, points: 8, faces: HEXAHEDRON, is_curved: false },
    Shape { number: 13, points: 6, faces: WEDGE, is_curved: false },
    Shape { number: 14, points: 5, faces: PYRAMID, is_curved: false },
    Shape { number: 24, points: 4, faces: TETRAHEDRON, is_curved: true },
    Shape { number: 25, points: 8, faces: HEXAHEDRON, is_curved: true },
    Shape { number: 26, points: 6, faces: WEDGE, is_curved: true },
    Shape { number: 27, points: 5, faces: PYRAMID, is_curved: true },
];

/// The bytes of a tetrahedron, with the number of its cell.
const BYTES: u64 = 4 * 4 + 4;

/// Returns the tetrahedra, and the number of each one's cell.
pub(super) fn divided(
    grid: &Grid,
    points: usize,
    (budget, warnings): (&Budget, FileWarnings<'_>),
) -> Result<(Vec<[u32; 4]>, Vec<u32>), FileError> {
    let position = grid.cells_at.unwrap_or(FilePosition::Line(1));
    let error = |message: String| FileError::Malformed(position, message);
    if grid.types.len() != grid.ends.len() {
        return Err(error(format!("{} cells have {} types", grid.ends.len(), grid.types.len())));
    }
    let (mut tetrahedra, mut cells, mut begin) = (Vec::new(), Vec::new(), 0);
    for (cell, (end, number)) in (0..).zip(grid.ends.iter().zip(&grid.types)) {
        let end = *end as usize;
        let Some(corners) = grid.connectivity.get(begin..end) else {
            let length = grid.connectivity.len();
            return Err(error(format!("cell {cell} ends at {end}: it begins at {begin} of {length} points of cells")));
        };
        begin = end;
        let Some(shape) = SHAPES.iter().find(|shape| f64::from(shape.number) == *number) else {
            warnings.add(WarningKind::NotRead, &format!("cells {number}"), || {
                (position, format!("cells of the type {number} have no tetrahedra and are not read"))
            });
            continue;
        };
        let Some(corners) = corners.get(..shape.points) else {
            let (has, needs) = (corners.len(), shape.points);
            return Err(error(format!("cell {cell} of the type {number} has {has} points of {needs}")));
        };
        if let Some(index) = corners.iter().find(|index| !(**index >= 0.0 && **index < points as f64)) {
            return Err(error(format!("cell {cell} has no point {index}: the grid has {points}")));
        }
        if shape.is_curved {
            warnings.add(WarningKind::NotRead, "curved cells", || {
                (position, Message::new("curved cells are not read", "they have straight edges"))
            });
        }
        let before = tetrahedra.len();
        shape.divide(corners, |corners| {
            // Twice the same point: no volume.
            let is_flat = (0..4).any(|at| corners[..at].contains(&corners[at]));
            if is_flat {
                warnings.add(WarningKind::DegenerateFace, "", || {
                    (position, Message::new(format!("cell {cell} has a point twice"), "its flat part is skipped"))
                });
            } else {
                tetrahedra.push(corners);
            }
        });
        let added = tetrahedra.len() - before;
        budget.take(added as u64, BYTES, "the tetrahedra")?;
        cells.extend(std::iter::repeat_n(cell, added));
    }
    if tetrahedra.is_empty() {
        let help = "give a grid of tetrahedra, hexahedra, wedges or pyramids, and a surface as PLY";
        return Err(error(format!("the grid has no tetrahedra: {help}")));
    }
    Ok((tetrahedra, cells))
}

impl Shape {
    /// Calls `add` for each tetrahedron of a cell.
    fn divide(&self, corners: &[f64], mut add: impl FnMut([u32; 4])) {
        let point = |at: usize| corners.get(at).copied().unwrap_or_default() as u32;
        let least = (0..self.points).map(point).min().unwrap_or_default();
        if self.points == 4 {
            return add([point(0), point(1), point(2), point(3)]);
        }
        for face in self.faces.iter().filter(|face| face.iter().all(|at| point(*at) != least)) {
            let first = (0..face.len()).min_by_key(|at| face.get(*at).map_or(u32::MAX, |at| point(*at))).unwrap_or(0);
            let at = |turn: usize| face.get((first + turn) % face.len()).map_or(0, |at| point(*at));
            (1..face.len() - 1).for_each(|turn| add([least, at(0), at(turn), at(turn + 1)]));
        }
    }
}
