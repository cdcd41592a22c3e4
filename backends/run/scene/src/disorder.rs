//! The disorder of a sequence of fragments: how far it is from sorted.

use crate::DepthOrder;

/// Returns the greatest distance of a fragment from its place in the sorted sequence: the least k for which the depths of a pixel, in the order
/// of their arrival, are a k-nearly sorted sequence (k-NSS; Callahan et al. 2005; B06 §3). Fragments of equal depths keep their order, so they are in
/// place. 0: the sequence is sorted.
///
/// The disorder of an image is the greatest of its pixels: "the maximum disorder over the image in the nearly-sorted sequences of fragments for
/// every pixel" (B06, Table 2).
///
/// ```
/// use fragbuf_scene::{DepthOrder, disorder};
///
/// // The last fragment belongs to the front; each other one has to move by one.
/// assert_eq!(disorder(&[0.2, 0.3, 0.4, 0.1], DepthOrder::NearestFirst), 3);
/// ```
pub fn disorder(depths: &[f32], order: DepthOrder) -> u32 {
    // The sum makes 0 of -0, which equals it.
    let mut sorted: Vec<(u32, usize)> = depths.iter().map(|depth| order.key(*depth + 0.0)).zip(0..).collect();
    // Stable, by the second number.
    sorted.sort_unstable();
    let distances = sorted.iter().enumerate().map(|(place, (_, arrival))| place.abs_diff(*arrival));
    distances.max().unwrap_or(0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disorder_is_the_greatest_distance() {
        let of = |depths: &[f32]| disorder(depths, DepthOrder::NearestFirst);
        assert_eq!((of(&[]), of(&[0.5]), of(&[0.1, 0.2, 0.3])), (0, 0, 0));
        assert_eq!(of(&[0.3, 0.2, 0.1]), 2);
        assert_eq!(of(&[0.2, 0.1, 0.4, 0.3]), 1);
        // Equal depths are in place in the order of arrival, on both sides of a lesser one.
        assert_eq!(of(&[0.5, 0.5, 0.5]), 0);
        assert_eq!(of(&[0.5, 0.5, 0.1]), 2);
        assert_eq!(disorder(&[0.3, 0.2, 0.1], DepthOrder::FarthestFirst), 0);
        assert_eq!(disorder(&[0.1, 0.1, 0.2], DepthOrder::FarthestFirst), 2);
        assert_eq!(of(&[-1.0, -2.0]), 1);
    }
}
