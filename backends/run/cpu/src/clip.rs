//! Clips triangles in homogeneous coordinates against the eye plane, the near and far planes, and a guard band that keeps
//! coordinates within the rasteriser's integers.
//!
//! The result is a convex polygon; each corner has a weight per corner of the triangle. A clipped edge depends only on its
//! ends, so triangles with a common edge leave no gap.

/// A corner of a clipped triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// In clip space.
    pub(crate) position: [f32; 4],
    /// Its weights of the corners of the triangle; their sum is one.
    pub(crate) weights: [f32; 3],
}

/// The clipped triangle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ClipResult {
    /// The triangle needs no clipping.
    Inside,
    /// A polygon of at least three corners.
    Polygon(Vec<Corner>),
    /// Nothing is left.
    Empty,
}

/// The least w of a corner: w is 0 in the eye plane.
const LEAST_W: f32 = 1.0 / (1u64 << 60) as f32;

/// The greatest distance of coordinates from the centre of the frame, in pixels: with 8 subpixel bits, products of two
/// coordinates fit into 63 bits.
const GUARD: f32 = 1_048_576.0;

/// The signed distance of a position from a plane; negative outside.
type Plane = fn(&[f32; 4], (f32, f32)) -> f32;

const PLANES: [Plane; 7] = [
    |p, _| p[3] - LEAST_W,
    |p, _| p[2],
    |p, _| p[3] - p[2],
    |p, (x, _)| x * p[3] + p[0],
    |p, (x, _)| x * p[3] - p[0],
    |p, (_, y)| y * p[3] + p[1],
    |p, (_, y)| y * p[3] - p[1],
];

/// Clips a triangle for a frame of this size.
pub(crate) fn clip(positions: [[f32; 4]; 3], (width, height): (u32, u32)) -> ClipResult {
    if positions.iter().flatten().any(|number| !number.is_finite()) {
        return ClipResult::Empty;
    }
    let beyond = |outside: fn(&[f32; 4]) -> bool| positions.iter().all(outside);
    if beyond(|p| p[0] < -p[3]) || beyond(|p| p[0] > p[3]) || beyond(|p| p[1] < -p[3]) || beyond(|p| p[1] > p[3]) {
        return ClipResult::Empty;
    }
    let guard = (2.0 * GUARD / width as f32, 2.0 * GUARD / height as f32);
    let is_inside = |plane: &Plane| positions.iter().all(|position| plane(position, guard) >= 0.0);
    if PLANES.iter().all(is_inside) {
        return ClipResult::Inside;
    }
    let mut weights = [[0.0; 3]; 3];
    (0..3).for_each(|corner| weights[corner][corner] = 1.0);
    let mut polygon: Vec<Corner> =
        positions.into_iter().zip(weights).map(|(position, weights)| Corner { position, weights }).collect();
    for plane in PLANES {
        polygon = clip_by(&polygon, plane, guard);
    }
    if polygon.len() < 3 { ClipResult::Empty } else { ClipResult::Polygon(polygon) }
}

/// Clips a polygon against one plane.
fn clip_by(polygon: &[Corner], plane: Plane, guard: (f32, f32)) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (index, corner) in polygon.iter().enumerate() {
        let next = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (plane(&corner.position, guard), plane(&next.position, guard));
        if here >= 0.0 {
            kept.push(*corner);
        }
        // Interpolate from the inner end, so that both triangles at the edge compute the same point.
        match (here >= 0.0, there >= 0.0) {
            (true, false) => kept.push(between(corner, next, here / (here - there))),
            (false, true) => kept.push(between(next, corner, there / (there - here))),
            _ => {}
        }
    }
    kept
}

fn between(from: &Corner, to: &Corner, share: f32) -> Corner {
    let mix = |a: f32, b: f32| a + share * (b - a);
    Corner {
        position: std::array::from_fn(|axis| mix(from.position[axis], to.position[axis])),
        weights: std::array::from_fn(|corner| mix(from.weights[corner], to.weights[corner])),
    }
}

#[cfg(test)]
#[allow(clippy::panic, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (64, 64);

    #[test]
    fn inner_triangles_are_not_clipped_and_outer_ones_are_dropped() {
        let inside = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 1.0, 1.0], [0.0, -1.0, 0.5, 1.0]];
        assert_eq!(clip(inside, SIZE), ClipResult::Inside);
        assert_eq!(clip(inside.map(|p| [p[0] + 2.5, p[1], p[2], p[3]]), SIZE), ClipResult::Empty);
        assert_eq!(clip(inside.map(|p| [p[0], p[1], p[2] + 1.5, p[3]]), SIZE), ClipResult::Empty);
        assert_eq!(clip(inside.map(|p| [p[0], p[1], p[2], -p[3]]), SIZE), ClipResult::Empty);
        assert_eq!(clip([[f32::NAN; 4]; 3], SIZE), ClipResult::Empty);
    }

    #[test]
    fn the_near_plane_clips_at_depth_zero() {
        let ClipResult::Polygon(polygon) =
            clip([[0.0, 0.0, -1.0, 1.0], [0.5, 0.0, 1.0, 1.0], [0.0, 0.5, 1.0, 1.0]], SIZE)
        else {
            panic!("not clipped");
        };
        assert_eq!(polygon.len(), 4);
        for corner in &polygon {
            assert!(corner.position[2] >= 0.0);
            assert!((corner.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        let on_plane: Vec<&Corner> = polygon.iter().filter(|corner| corner.position[2] == 0.0).collect();
        assert_eq!(on_plane.len(), 2);
        assert!(on_plane.iter().all(|corner| corner.weights[0] == 0.5));
    }

    #[test]
    fn both_triangles_of_an_edge_clip_it_at_the_same_point() {
        let (a, b) = ([0.3, 0.1, -0.7, 1.3], [-0.2, 0.6, 0.9, 1.1]);
        let points = |other: [f32; 4], turned: bool| -> Vec<[f32; 4]> {
            let triangle = if turned { [b, a, other] } else { [a, b, other] };
            let ClipResult::Polygon(polygon) = clip(triangle, SIZE) else { panic!("not clipped") };
            polygon.iter().filter(|c| c.weights[2] == 0.0 && c.position[2].abs() < 1e-6).map(|c| c.position).collect()
        };
        assert_eq!(points([0.9, 0.9, 0.9, 1.0], false), points([-0.9, -0.9, 0.2, 1.0], true));
    }

    #[test]
    fn nothing_behind_the_eye_is_left() {
        let ClipResult::Polygon(polygon) =
            clip([[0.0, 0.0, 0.5, 1.0], [0.0, 0.5, -2.0, -1.0], [0.5, 0.0, 0.5, 1.0]], SIZE)
        else {
            panic!("not clipped");
        };
        assert!(polygon.iter().all(|corner| corner.position[3] > 0.0));
    }
}
