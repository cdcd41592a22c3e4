//! Divides the faces of models into triangles: convex ones as a fan, concave ones by cutting ears.
//!
//! Input: the corners of a face. Output: triangles with the orientation of the face. A face that is not plane is projected along its
//! mean normal; one without area becomes a fan.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;

use crate::Object;

/// The greatest number of corners of a concave face: cutting ears may take the square of their number.
const MAX_CONCAVE: usize = 4096;

/// Turns of at most this size, in the square of the size of a face, count as none.
const STRAIGHT: f64 = 1.0e-9;

/// Divides faces; the lists are kept from face to face.
pub(crate) struct Triangulator {
    earcut: Earcut<f64>,
    corners: Vec<[f64; 3]>,
    plane: Vec<[f64; 2]>,
    triangles: Vec<u32>,
}

impl Triangulator {
    pub(crate) fn new() -> Self {
        Triangulator { earcut: Earcut::new(), corners: Vec::new(), plane: Vec::new(), triangles: Vec::new() }
    }

    /// Adds the triangles of a face. `Err`: a message.
    pub(crate) fn add(&mut self, face: &[u32], object: &mut Object) -> Result<(), String> {
        if face.len() < 4 || !self.project(face, object) || is_convex(&self.plane) {
            object.polygon(face);
            return Ok(());
        }
        if face.len() > MAX_CONCAVE {
            return Err(format!("a concave face with {} corners: it can have {MAX_CONCAVE}", face.len()));
        }
        let no_holes: [u32; 0] = [];
        self.earcut.earcut(self.plane.iter().copied(), &no_holes, &mut self.triangles);
        for triangle in self.triangles.chunks_exact(3) {
            let corner = |at: usize| {
                let index = triangle.get(at).map_or(0, |index| *index as usize);
                Some((*self.plane.get(index)?, *face.get(index)?))
            };
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
            let is_turned = turn(a.0, b.0, c.0) < 0.0;
            object.triangles.push(if is_turned { [a.1, c.1, b.1] } else { [a.1, b.1, c.1] });
        }
        Ok(())
    }

    /// Projects a face to a plane in which it runs counter-clockwise, at a size of about 1. Returns whether it has an area.
    fn project(&mut self, face: &[u32], object: &Object) -> bool {
        let positions = face.iter().map(|index| object.positions.get(*index as usize).copied().unwrap_or_default());
        self.corners.clear();
        self.corners.extend(positions.map(|position| position.map(f64::from)));
        let Some(first) = self.corners.first().copied() else { return false };
        let distance = |corner: &[f64; 3]| (0..3).map(|axis| (corner[axis] - first[axis]).abs()).fold(0.0, f64::max);
        let size = self.corners.iter().map(distance).fold(0.0, f64::max);
        if size == 0.0 {
            return false;
        }
        for corner in &mut self.corners {
            *corner = std::array::from_fn(|axis| (corner[axis] - first[axis]) / size);
        }
        project3d_to_2d(&self.corners, self.corners.len(), &mut self.plane)
    }
}

/// Whether a counter-clockwise polygon has no turn to the right.
fn is_convex(polygon: &[[f64; 2]]) -> bool {
    let at = |index: usize| polygon.get(index % polygon.len()).copied().unwrap_or_default();
    (0..polygon.len()).all(|index| turn(at(index), at(index + 1), at(index + 2)) >= -STRAIGHT)
}

/// Returns twice the area of a triangle; negative if it runs clockwise.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
