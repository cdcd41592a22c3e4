//! Faces, vertices and gradients of two tetrahedra that share a face.
#![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

use super::{Face, faces, gradients, vertices, volume};
use crate::Limits;
use crate::limits::Budget;

const POINTS: [[f64; 3]; 5] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];

fn budget() -> Budget {
    Budget::new(&Limits::default())
}

/// Returns whether a face is seen counter-clockwise from the side that is not that of the other corner of its tetrahedron.
fn is_outward(face: &Face, tetrahedron: [u32; 4]) -> bool {
    let other = tetrahedron.into_iter().find(|index| !face.corners.contains(index)).unwrap();
    let [a, b, c] = face.corners;
    volume(&POINTS, [a, b, c, other]) < 0.0
}

#[test]
fn every_face_is_listed_once_with_its_front_outside() {
    // In both orders of the corners.
    for tetrahedra in [[[0, 1, 2, 3], [1, 2, 3, 4]], [[0, 2, 1, 3], [1, 3, 2, 4]]] {
        let found = faces(&POINTS, &tetrahedra, &budget()).unwrap();
        assert_eq!(found.len(), 7);
        assert_eq!(found.iter().filter(|face| face.is_boundary).count(), 6);
        for face in &found {
            assert!(is_outward(face, tetrahedra[face.tetrahedron as usize]), "{face:?}");
            let mut corners = face.corners;
            corners.sort_unstable();
            assert_eq!(face.is_boundary, corners != [1, 2, 3]);
        }
    }
}

#[test]
fn surface_and_interior_have_vertices_of_their_own() {
    let tetrahedra = [[0, 1, 2, 3], [1, 2, 3, 4]];
    let found = faces(&POINTS, &tetrahedra, &budget()).unwrap();
    let (corners, triangles) = vertices(POINTS.len(), &found, false, &budget()).unwrap();
    // Five points of the surface, and three of the face inside.
    assert_eq!((corners.len(), triangles.len()), (8, 7));
    for (face, triangle) in found.iter().zip(&triangles) {
        let of = triangle.map(|index| corners[index as usize]);
        assert_eq!(of.map(|corner| corner.point), face.corners);
        assert!(of.iter().all(|corner| corner.face.is_boundary == face.is_boundary));
    }
    let (corners, triangles) = vertices(POINTS.len(), &found, true, &budget()).unwrap();
    assert_eq!((corners.len(), triangles.last()), (21, Some(&[18, 19, 20])));
}

#[test]
fn the_gradient_of_a_linear_function_is_exact() {
    let values = POINTS.map(|[x, y, z]| 2.0 * x - 3.0 * y + 0.5 * z + 7.0);
    for tetrahedra in [[[0, 1, 2, 3], [1, 2, 3, 4]], [[0, 2, 1, 3], [1, 3, 2, 4]]] {
        for gradient in gradients(&POINTS, &tetrahedra, &values) {
            let errors = gradient.iter().zip([2.0, -3.0, 0.5]).map(|(a, b)| (a - b).abs());
            assert!(errors.fold(0.0, f64::max) < 1.0e-12, "{gradient:?}");
        }
    }
    assert_eq!(gradients(&POINTS, &[], &values), [[0.0; 3]; 5]);
}
