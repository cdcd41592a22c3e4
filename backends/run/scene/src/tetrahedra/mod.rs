//! The triangles of a tetrahedral mesh: every face once.
//!
//! Input: points, and tetrahedra as four indices of points. Output: the faces, and the vertices that they need. A face of one tetrahedron is part of
//! the surface and has its front side outside. A face between two tetrahedra is listed once; its front side is that of the first of them.

mod gradient;

pub(crate) use gradient::gradients;

use crate::error::FileError;
use crate::limits::Budget;

/// The bytes of a face while it is searched: its sorted corners, its number, and how often it was found.
const FACE: u64 = 3 * 4 + 4 + 1;

/// The bytes of a face in the list of faces.
const LISTED: u64 = size_of::<Face>() as u64;

/// The greatest number of tetrahedra, so that their faces have numbers of 32 bits.
const MAX_TETRAHEDRA: usize = (u32::MAX / 4) as usize;

/// A triangle between two tetrahedra, or on the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Face {
    /// The indices of its points, counter-clockwise as seen from outside of its tetrahedron.
    pub(crate) corners: [u32; 3],
    /// The first tetrahedron that it belongs to.
    pub(crate) tetrahedron: u32,
    /// Whether it belongs to one tetrahedron only.
    pub(crate) is_boundary: bool,
}

/// A vertex of the triangles: a point as a corner of one face, or of all faces inside or on the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corner {
    pub(crate) point: u32,
    /// The first face that has it.
    pub(crate) face: Face,
}

/// The corners of the faces of a tetrahedron of positive volume, each seen from outside.
const CORNERS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Returns the faces in the order of their tetrahedra. Indices are those of `points`.
pub(crate) fn faces(points: &[[f64; 3]], tetrahedra: &[[u32; 4]], budget: &Budget) -> Result<Vec<Face>, FileError> {
    if tetrahedra.len() > MAX_TETRAHEDRA {
        let message = format!("the file is too large: {} tetrahedra, and {MAX_TETRAHEDRA} are read", tetrahedra.len());
        return Err(FileError::whole(message));
    }
    let count = 4 * tetrahedra.len();
    let _held = budget.hold(count as u64, FACE, "the faces of the tetrahedra")?;
    let oriented: Vec<[u32; 4]> = tetrahedra.iter().map(|corners| oriented(points, *corners)).collect();
    let face = |number: usize| {
        let corners = oriented.get(number / 4).copied().unwrap_or_default();
        CORNERS.get(number % 4).copied().unwrap_or_default().map(|at| corners.get(at).copied().unwrap_or_default())
    };
    let mut sorted: Vec<([u32; 3], u32)> = (0..count)
        .map(|number| {
            let mut corners = face(number);
            corners.sort_unstable();
            (corners, number as u32)
        })
        .collect();
    sorted.sort_unstable();
    let mut found = vec![0_u8; count];
    for equal in sorted.chunk_by(|(a, _), (b, _)| a == b) {
        if let Some(times) = equal.first().and_then(|(_, number)| found.get_mut(*number as usize)) {
            *times = equal.len().min(2) as u8;
        }
    }
    drop(sorted);
    budget.take(found.iter().filter(|times| **times > 0).count() as u64, LISTED, "the faces of the tetrahedra")?;
    let listed = (0..count).zip(&found).filter(|(_, times)| **times > 0);
    Ok(listed
        .map(|(number, times)| Face {
            corners: face(number),
            tetrahedron: (number / 4) as u32,
            is_boundary: *times == 1,
        })
        .collect())
}

/// Returns the corners in an order of positive volume.
fn oriented(points: &[[f64; 3]], [a, b, c, d]: [u32; 4]) -> [u32; 4] {
    if volume(points, [a, b, c, d]) < 0.0 { [a, c, b, d] } else { [a, b, c, d] }
}

/// Returns six times the volume of a tetrahedron, negative if its first three corners are clockwise as seen from outside.
pub(crate) fn volume(points: &[[f64; 3]], corners: [u32; 4]) -> f64 {
    let [a, b, c, d] = corners.map(|index| point(points, index));
    (b - a).cross(c - a).dot(d - a)
}

pub(crate) fn point(points: &[[f64; 3]], index: u32) -> glam::DVec3 {
    points.get(index as usize).copied().unwrap_or_default().into()
}

/// Returns the vertices of the faces, and the indices of each face's vertices. A point is one vertex for all faces of the surface and another one
/// for all faces inside; with `per_face`, it is one for each face.
pub(crate) fn vertices(
    points: usize,
    faces: &[Face],
    per_face: bool,
    budget: &Budget,
) -> Result<(Vec<Corner>, Vec<[u32; 3]>), FileError> {
    let most = if per_face { 3 * faces.len() } else { (2 * points).min(3 * faces.len()) };
    budget.take(most as u64, size_of::<Corner>() as u64, "the vertices of the faces")?;
    let _held = budget.hold(2 * points as u64, 4, "the vertices of the faces")?;
    let mut known = vec![u32::MAX; 2 * points];
    let mut corners: Vec<Corner> = Vec::new();
    let triangles = faces.iter().map(|face| {
        face.corners.map(|point| {
            let next = corners.len() as u32;
            let slot = known.get_mut(2 * point as usize + usize::from(face.is_boundary));
            let index = match slot {
                Some(slot) if !per_face => {
                    *slot = (*slot).min(next);
                    *slot
                }
                _ => next,
            };
            if index == next {
                corners.push(Corner { point, face: *face });
            }
            index
        })
    });
    let triangles = triangles.collect();
    Ok((corners, triangles))
}

#[cfg(test)]
mod tests;
