//! Clipping in homogeneous coordinates: what of a triangle lies in front of the eye, between near and far plane, and near
//! enough to the frame for the rasteriser's whole numbers.
//!
//! In: three positions. Out: a convex polygon, each corner with its share of the three. Where an edge is cut depends on its
//! ends alone, so triangles that share it stay closed.

/// A corner of a clipped triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// In clip space.
    pub(crate) position: [f32; 4],
    /// How much it is of each corner of the triangle; they add up to one.
    pub(crate) shares: [f32; 3],
}

/// What is left of a triangle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Clipped {
    /// All of it.
    Whole,
    /// A polygon of at least three corners.
    Part(Vec<Corner>),
    Nothing,
}

/// The nearest that a corner may come to the plane of the eye, where perspective ends.
const LEAST_W: f32 = 1.0 / (1u64 << 60) as f32;

/// Pixels from the frame's middle that coordinates may reach: with 8 bits of subpixel, products of two stay within 63 bits.
const GUARD: f32 = 1_048_576.0;

/// How far inside of a plane a position is; negative: outside.
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

/// What of the triangle is drawn into a frame of this size.
pub(crate) fn clip(positions: [[f32; 4]; 3], (width, height): (u32, u32)) -> Clipped {
    if positions.iter().flatten().any(|number| !number.is_finite()) {
        return Clipped::Nothing;
    }
    let beyond = |outside: fn(&[f32; 4]) -> bool| positions.iter().all(outside);
    if beyond(|p| p[0] < -p[3]) || beyond(|p| p[0] > p[3]) || beyond(|p| p[1] < -p[3]) || beyond(|p| p[1] > p[3]) {
        return Clipped::Nothing;
    }
    let guard = (2.0 * GUARD / width as f32, 2.0 * GUARD / height as f32);
    let is_inside = |plane: &Plane| positions.iter().all(|position| plane(position, guard) >= 0.0);
    if PLANES.iter().all(is_inside) {
        return Clipped::Whole;
    }
    let mut shares = [[0.0; 3]; 3];
    (0..3).for_each(|corner| shares[corner][corner] = 1.0);
    let mut polygon: Vec<Corner> =
        positions.into_iter().zip(shares).map(|(position, shares)| Corner { position, shares }).collect();
    for plane in PLANES {
        polygon = cut(&polygon, plane, guard);
    }
    if polygon.len() < 3 { Clipped::Nothing } else { Clipped::Part(polygon) }
}

/// The part of a polygon inside of one plane.
fn cut(polygon: &[Corner], plane: Plane, guard: (f32, f32)) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (index, corner) in polygon.iter().enumerate() {
        let next = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (plane(&corner.position, guard), plane(&next.position, guard));
        if here >= 0.0 {
            kept.push(*corner);
        }
        // Always from the end inside, so that both triangles at the edge find the same place.
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
        shares: std::array::from_fn(|corner| mix(from.shares[corner], to.shares[corner])),
    }
}

#[cfg(test)]
#[allow(clippy::panic, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (64, 64);

    #[test]
    fn what_is_inside_stays_whole_and_what_is_outside_goes() {
        let inside = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 1.0, 1.0], [0.0, -1.0, 0.5, 1.0]];
        assert_eq!(clip(inside, SIZE), Clipped::Whole);
        assert_eq!(clip(inside.map(|p| [p[0] + 2.5, p[1], p[2], p[3]]), SIZE), Clipped::Nothing);
        assert_eq!(clip(inside.map(|p| [p[0], p[1], p[2] + 1.5, p[3]]), SIZE), Clipped::Nothing);
        assert_eq!(clip(inside.map(|p| [p[0], p[1], p[2], -p[3]]), SIZE), Clipped::Nothing);
        assert_eq!(clip([[f32::NAN; 4]; 3], SIZE), Clipped::Nothing);
    }

    #[test]
    fn the_near_plane_cuts_where_depth_is_zero() {
        let Clipped::Part(polygon) = clip([[0.0, 0.0, -1.0, 1.0], [0.5, 0.0, 1.0, 1.0], [0.0, 0.5, 1.0, 1.0]], SIZE)
        else {
            panic!("it is cut");
        };
        assert_eq!(polygon.len(), 4);
        for corner in &polygon {
            assert!(corner.position[2] >= 0.0);
            assert!((corner.shares.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        let cut: Vec<&Corner> = polygon.iter().filter(|corner| corner.position[2] == 0.0).collect();
        assert_eq!(cut.len(), 2);
        assert!(cut.iter().all(|corner| corner.shares[0] == 0.5));
    }

    #[test]
    fn an_edge_is_cut_at_one_place_from_both_sides() {
        let (a, b) = ([0.3, 0.1, -0.7, 1.3], [-0.2, 0.6, 0.9, 1.1]);
        let places = |other: [f32; 4], turned: bool| -> Vec<[f32; 4]> {
            let triangle = if turned { [b, a, other] } else { [a, b, other] };
            let Clipped::Part(polygon) = clip(triangle, SIZE) else { panic!("it is cut") };
            polygon.iter().filter(|c| c.shares[2] == 0.0 && c.position[2].abs() < 1e-6).map(|c| c.position).collect()
        };
        assert_eq!(places([0.9, 0.9, 0.9, 1.0], false), places([-0.9, -0.9, 0.2, 1.0], true));
    }

    #[test]
    fn behind_the_eye_nothing_is_left() {
        let Clipped::Part(polygon) = clip([[0.0, 0.0, 0.5, 1.0], [0.0, 0.5, -2.0, -1.0], [0.5, 0.0, 0.5, 1.0]], SIZE)
        else {
            panic!("it is cut");
        };
        assert!(polygon.iter().all(|corner| corner.position[3] > 0.0));
    }
}
