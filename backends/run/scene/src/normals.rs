//! Computes missing normals: the mean of the triangles around a vertex, weighted by area.

use glam::Vec3;

use crate::Object;

/// Replaces zero normals, and normalises all normals. A vertex without triangles of non-zero area gets the z axis.
pub(crate) fn complete(object: &mut Object) {
    let mut sums = vec![Vec3::ZERO; object.positions.len()];
    if object.normals.iter().any(|normal| Vec3::from_array(*normal) == Vec3::ZERO) {
        for triangle in &object.triangles {
            let corners = triangle
                .map(|index| object.positions.get(index as usize).copied().map_or(Vec3::ZERO, Vec3::from_array));
            let [a, b, c] = corners;
            let area = (b - a).cross(c - a);
            for index in triangle {
                if let Some(sum) = sums.get_mut(*index as usize) {
                    *sum += area;
                }
            }
        }
    }
    for (normal, sum) in object.normals.iter_mut().zip(sums) {
        let given = Vec3::from_array(*normal);
        let normal_or_mean = if given == Vec3::ZERO { sum } else { given };
        *normal = unit(normal_or_mean).to_array();
    }
}

/// Returns a vector of length 1. It is divided by its greatest component first, because the squares of small or large ones have no `f32`.
fn unit(vector: Vec3) -> Vec3 {
    (vector / vector.abs().max_element()).normalize_or(Vec3::Z)
}
