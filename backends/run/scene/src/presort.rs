//! Sorting triangles by the depth of their centroids, before they are drawn (B06 §3.2, §4.3).
//!
//! Input: a scene and a camera. Output: the order of its triangles; the objects and their ids stay. The sort is a radix sort of the bits of the
//! depths from the least significant digit, linear in the number of triangles, as in B06: "a Least Significant Digit Radix Sort, which operates in
//! linear time on floating point values with a simple float-to-int conversion".

use crate::scene::TriangleId;
use crate::{Camera, Scene};

/// The order of depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthOrder {
    /// From front to back, which compositing from front to back needs.
    NearestFirst,
    /// From back to front.
    FarthestFirst,
}

impl DepthOrder {
    /// Returns an integer that orders numbers as the order of depths does. -0 is before 0.
    pub(crate) fn key(self, depth: f32) -> u32 {
        let bits = depth.to_bits();
        let ascending = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
        match self {
            DepthOrder::NearestFirst => ascending,
            DepthOrder::FarthestFirst => !ascending,
        }
    }
}

impl Scene {
    /// Sets the order of triangles to that of the depths of their centroids. Triangles of equal depths keep the order of the model.
    ///
    /// The depth is the third component of the centroid in clip space before the division by the fourth: it grows with the distance to the
    /// image plane, of parallel projections and behind the eye, too, and that of the centroid is the mean of those of the corners.
    pub fn presort(&mut self, camera: &Camera, order: DepthOrder) {
        let depths: Vec<Vec<f64>> = self.objects.iter().map(|object| depths(&object.positions, camera)).collect();
        let centroid = |id: TriangleId| {
            let depths = depths.get(id.object as usize);
            let corners = self.corners(id).into_iter().flatten();
            let sum: f64 = corners.filter_map(|corner| depths?.get(corner as usize)).sum();
            (sum / 3.0) as f32
        };
        self.order = sorted(self.triangle_ids().map(|id| (order.key(centroid(id)), id)).collect());
    }
}

/// Returns the depth of every position.
fn depths(positions: &[[f32; 3]], camera: &Camera) -> Vec<f64> {
    let row = [2, 6, 10, 14].map(|index| f64::from(camera.view_projection[index]));
    let depth = |position: &[f32; 3]| {
        let [x, y, z] = position.map(f64::from);
        row[0] * x + row[1] * y + row[2] * z + row[3]
    };
    positions.iter().map(depth).collect()
}

/// The bits of a digit, and the numbers that it can have.
const DIGIT: u32 = 8;
const NUMBERS: usize = 1 << DIGIT;

/// Returns the triangles in ascending order of their keys. The sort is stable.
fn sorted(mut keyed: Vec<(u32, TriangleId)>) -> Vec<TriangleId> {
    let mut other = keyed.clone();
    for shift in (0..u32::BITS).step_by(DIGIT as usize) {
        let digit = |key: u32| (key >> shift) as usize % NUMBERS;
        let mut next = [0_usize; NUMBERS];
        keyed.iter().for_each(|(key, _)| next[digit(*key)] += 1);
        let mut begin = 0;
        for count in &mut next {
            begin += std::mem::replace(count, begin);
        }
        for one in &keyed {
            let at = &mut next[digit(one.0)];
            if let Some(slot) = other.get_mut(*at) {
                *slot = *one;
            }
            *at += 1;
        }
        std::mem::swap(&mut keyed, &mut other);
    }
    keyed.into_iter().map(|(_, id)| id).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_order_as_numbers_do() {
        let numbers = [f32::NEG_INFINITY, -2.5, -1.0, -1.0e-40, -0.0, 0.0, 1.0e-40, 0.5, 1.0, 3.0e38, f32::INFINITY];
        let ascending = numbers.map(|number| DepthOrder::NearestFirst.key(number));
        assert!(ascending.windows(2).all(|pair| pair[0] < pair[1]), "{ascending:?}");
        let descending = numbers.map(|number| DepthOrder::FarthestFirst.key(number));
        assert!(descending.windows(2).all(|pair| pair[0] > pair[1]), "{descending:?}");
    }

    #[test]
    fn the_radix_sort_is_a_stable_sort() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state
        };
        for count in [0, 1, 2, 300, 5000] {
            // Few keys, so that many are equal, with digits in all places.
            let id = |triangle| TriangleId { object: 0, triangle };
            let keyed: Vec<(u32, TriangleId)> =
                (0..count).map(|triangle| ((random() >> 16) % 97 * 0x0101_4321, id(triangle))).collect();
            let mut expected = keyed.clone();
            expected.sort_by_key(|(key, _)| *key);
            let expected: Vec<TriangleId> = expected.into_iter().map(|(_, id)| id).collect();
            assert_eq!(sorted(keyed), expected);
        }
    }
}
