//! The gradient of numbers at the points of a tetrahedral mesh: the mean of the gradients in the tetrahedra around a point, weighted by volume.

use glam::DVec3;

use super::point;

/// Returns the gradient at each point. It is 0 at points without tetrahedra of a volume.
pub(crate) fn gradients(points: &[[f64; 3]], tetrahedra: &[[u32; 4]], values: &[f64]) -> Vec<[f64; 3]> {
    let mut sums = vec![(DVec3::ZERO, 0.0); points.len()];
    for corners in tetrahedra {
        let [a, b, c, d] = corners.map(|index| point(points, index));
        let (u, v, w) = (b - a, c - a, d - a);
        let volume = u.cross(v).dot(w);
        let [first, others @ ..] = corners.map(|index| values.get(index as usize).copied().unwrap_or_default());
        let [du, dv, dw] = others.map(|value| value - first);
        // The gradient times the volume, so that flat tetrahedra have no weight.
        let weighted = volume.signum() * (du * v.cross(w) + dv * w.cross(u) + dw * u.cross(v));
        if !weighted.is_finite() || volume == 0.0 {
            continue;
        }
        for index in corners {
            if let Some((sum, weight)) = sums.get_mut(*index as usize) {
                *sum += weighted;
                *weight += volume.abs();
            }
        }
    }
    let mean = |(sum, weight): (DVec3, f64)| if weight > 0.0 { (sum / weight).to_array() } else { [0.0; 3] };
    sums.into_iter().map(mean).collect()
}
