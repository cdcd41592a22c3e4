//! Divides the faces of models into triangles: convex ones as a fan, concave ones by cutting ears.
//!
//! Input: the corners of a face, one after the other. Output: triangles with the orientation of the face. A face that is not plane is
//! projected along its mean normal; one without area becomes a fan. The corners of a face are taken from the budget of the scene, and
//! the time for the concave faces of a model is limited.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;

use crate::error::FileError;
use crate::limits::{Budget, Held};
use crate::model::ModelObject;

/// The greatest number of corners of a concave face: cutting ears may take the square of their number.
const MAX_CONCAVE: usize = 4096;

/// The greatest sum, over the concave faces of a model, of the squares of their numbers of corners.
const MAX_SQUARES: u64 = 1 << 33;

/// The bytes of a corner in the lists: its vertex, its position and its projection.
const CORNER: u64 = (size_of::<u32>() + size_of::<[f64; 3]>() + size_of::<[f64; 2]>()) as u64;

/// The number of corners for which the lists keep their memory from face to face.
const KEPT: usize = 64;

/// Turns of at most this size, in the square of the size of a face, count as none.
const STRAIGHT: f64 = 1.0e-9;

/// Divides the faces of a model. A face begins with [`Triangulator::begin`] and ends with [`Triangulator::end`].
pub(crate) struct Triangulator {
    /// Its lists have at most [`MAX_CONCAVE`] corners.
    earcut: Earcut<f64>,
    face: Vec<u32>,
    corners: Vec<[f64; 3]>,
    plane: Vec<[f64; 2]>,
    triangles: Vec<u32>,
    /// The sum of the squares of the numbers of corners of the concave faces so far.
    squares: u64,
}

impl Triangulator {
    pub(crate) fn new() -> Self {
        Triangulator {
            earcut: Earcut::new(),
            face: Vec::new(),
            corners: Vec::new(),
            plane: Vec::new(),
            triangles: Vec::new(),
            squares: 0,
        }
    }

    /// Begins a face, and takes the memory of its `count` corners until the result is dropped.
    pub(crate) fn begin<'b>(&mut self, count: u64, budget: &'b Budget) -> Result<Held<'b>, FileError> {
        let held = budget.hold(count, CORNER, "the corners of a face")?;
        self.face.clear();
        self.face.reserve_exact(count as usize);
        Ok(held)
    }

    /// Adds a corner by its vertex.
    pub(crate) fn corner(&mut self, vertex: u32) {
        self.face.push(vertex);
    }

    /// Replaces every vertex of the face.
    pub(crate) fn replace<E>(&mut self, mut vertex: impl FnMut(u32) -> Result<u32, E>) -> Result<(), E> {
        for corner in &mut self.face {
            *corner = vertex(*corner)?;
        }
        Ok(())
    }

    /// Ends the face, and adds its triangles to the object of its vertices. `Err`: a message.
    pub(crate) fn end(&mut self, object: &mut ModelObject) -> Result<(), String> {
        let face = std::mem::take(&mut self.face);
        let divided = self.divide(&face, object);
        self.face = face;
        self.release();
        divided
    }

    /// Returns the memory of a large face to the system.
    fn release(&mut self) {
        self.face.clear();
        self.face.shrink_to(KEPT);
        self.corners.clear();
        self.corners.shrink_to(KEPT);
        self.plane.clear();
        self.plane.shrink_to(KEPT);
    }

    fn divide(&mut self, face: &[u32], object: &mut ModelObject) -> Result<(), String> {
        if face.len() < 4 || !self.project(face, object) || is_convex(&self.plane) {
            object.polygon(face);
            return Ok(());
        }
        self.limit(face.len())?;
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

    /// Checks that a concave face with `count` corners may be divided.
    fn limit(&mut self, count: usize) -> Result<(), String> {
        if count > MAX_CONCAVE {
            return Err(format!("a concave face with {count} corners: it can have {MAX_CONCAVE}"));
        }
        self.squares = self.squares.saturating_add((count as u64).pow(2));
        if self.squares > MAX_SQUARES {
            return Err(format!(
                "the concave faces so far have too many corners: the sum of the squares of their numbers of corners is {}, and it can be \
                 {MAX_SQUARES}; divide large faces into triangles",
                self.squares
            ));
        }
        Ok(())
    }

    /// Projects a face to a plane in which it runs counter-clockwise, at a size of about 1. Returns whether it has an area.
    fn project(&mut self, face: &[u32], object: &ModelObject) -> bool {
        let positions = face.iter().map(|index| object.positions.get(*index as usize).copied().unwrap_or_default());
        self.corners.clear();
        self.corners.reserve_exact(face.len());
        self.plane.clear();
        self.plane.reserve_exact(face.len());
        self.corners.extend(positions);
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::Limits;

    /// Returns a comb with `corners` corners, and its vertices.
    fn comb(corners: u32) -> ModelObject {
        let mut object = ModelObject::default();
        for at in 0..corners - 1 {
            object.vertex([at.into(), (at % 2).into(), 0.0], [0.0; 3], [1.0; 4]);
        }
        object.vertex([f64::from(corners) / 2.0, -9.0, 0.0], [0.0; 3], [1.0; 4]);
        object
    }

    fn add(triangulator: &mut Triangulator, object: &mut ModelObject, budget: &Budget) -> Result<(), String> {
        let count = object.positions.len() as u32;
        let _corners = triangulator.begin(count.into(), budget).map_err(|error| format!("{error:?}"))?;
        (0..count).for_each(|vertex| triangulator.corner(vertex));
        triangulator.end(object)
    }

    #[test]
    fn the_lists_of_a_face_are_within_the_budget() {
        let budget = Budget::new(&Limits { memory: 1 << 20, ..Limits::default() });
        let mut triangulator = Triangulator::new();
        for corners in [1001, 5, 3001] {
            let mut object = comb(corners);
            {
                let _corners = triangulator.begin(corners.into(), &budget).unwrap();
                (0..corners).for_each(|vertex| triangulator.corner(vertex));
                let face = std::mem::take(&mut triangulator.face);
                assert!(triangulator.project(&face, &object));
                let lists = (face.capacity(), triangulator.corners.capacity(), triangulator.plane.capacity());
                let bytes = 4 * lists.0 + 24 * lists.1 + 16 * lists.2;
                assert!(bytes as u64 <= CORNER * u64::from(corners).max(KEPT as u64), "{lists:?}");
                assert_eq!(budget.left(), (1 << 20) - CORNER * u64::from(corners));
            }
            add(&mut triangulator, &mut object, &budget).unwrap();
            assert!(!object.triangles.is_empty());
            let lists = [triangulator.face.capacity(), triangulator.corners.capacity(), triangulator.plane.capacity()];
            assert!(lists.iter().all(|capacity| *capacity <= KEPT), "{lists:?}");
            assert_eq!(budget.left(), 1 << 20);
        }
        // 44 bytes per corner.
        assert!(triangulator.begin(23_831, &budget).is_ok());
        assert!(triangulator.begin(23_832, &budget).is_err());
    }

    #[test]
    fn the_sum_over_concave_faces_is_limited() {
        let budget = Budget::new(&Limits::default());
        let mut triangulator = Triangulator::new();
        triangulator.squares = MAX_SQUARES - 2 * 25;
        for _ in 0..2 {
            assert_eq!(add(&mut triangulator, &mut comb(5), &budget), Ok(()));
        }
        let message = add(&mut triangulator, &mut comb(5), &budget).unwrap_err();
        assert!(message.contains("is 8589934617, and it can be 8589934592"), "{message}");
        // Convex faces have no limit.
        let mut square = ModelObject::default();
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            square.vertex([x, y, 0.0], [0.0; 3], [1.0; 4]);
        }
        assert_eq!(add(&mut triangulator, &mut square, &budget), Ok(()));
    }
}
