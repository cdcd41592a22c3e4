//! The boxes around objects that occlusion queries draw (D13 §3.3): their vertices, and the test for boxes that no query can
//! decide.
//!
//! Input: the least and the greatest corner of a box. Output: vertex words and triangle indices. This module draws nothing.

/// The triangles of a box, two per face. Bits 0, 1 and 2 of a corner's number say whether it is the greater along x, y and z.
pub const BOX_TRIANGLES: [u32; 36] =
    [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];

/// The number of corners of a box.
pub const BOX_CORNERS: usize = 8;

/// Returns the eight corners, indexed by their numbers.
pub fn box_corners(least: [f32; 3], greatest: [f32; 3]) -> [[f32; 3]; BOX_CORNERS] {
    std::array::from_fn(|corner| {
        std::array::from_fn(|axis| if corner >> axis & 1 == 1 { greatest[axis] } else { least[axis] })
    })
}

/// Returns the least and the greatest corner of the box around positions; `None`: there are none.
pub fn box_around(mut positions: impl Iterator<Item = [f32; 3]>) -> Option<([f32; 3], [f32; 3])> {
    let first = positions.next()?;
    let pick = |choose: fn(f32, f32) -> f32, from: [f32; 3], at: [f32; 3]| -> [f32; 3] {
        std::array::from_fn(|axis| choose(from[axis], at[axis]))
    };
    Some(
        positions
            .fold((first, first), |(least, greatest), at| (pick(f32::min, least, at), pick(f32::max, greatest, at))),
    )
}

/// Returns a box that is larger by 1/64 of its greatest extent at each side: rasterisers round positions, and an object must not be
/// dropped for it.
pub fn grown_box(least: [f32; 3], greatest: [f32; 3]) -> ([f32; 3], [f32; 3]) {
    let extent = (0..3).map(|axis| greatest[axis] - least[axis]).fold(0.0, f32::max);
    (least.map(|number| number - extent / 64.0), greatest.map(|number| number + extent / 64.0))
}

/// Whether a box with these corners in clip space covers less than a pixel of a frame of this size in both directions. Rounding can
/// then remove all its samples although the object covers a pixel.
pub fn is_below_a_pixel(corners: &[[f32; 4]], (width, height): (u32, u32)) -> bool {
    let extent = |axis: usize, pixels: u32| {
        let places = corners.iter().map(|corner| corner[axis] / corner[3] * 0.5 * pixels as f32);
        let (least, greatest) =
            places.fold((f32::MAX, f32::MIN), |(least, greatest), at| (least.min(at), greatest.max(at)));
        greatest - least
    };
    extent(0, width) < 1.0 && extent(1, height) < 1.0
}

/// Returns the corners as vertices of `stride` words: the position first, all other attributes zero.
pub fn box_vertices(least: [f32; 3], greatest: [f32; 3], stride: usize) -> Vec<u32> {
    let mut vertices = vec![0; BOX_CORNERS * stride];
    for (vertex, corner) in vertices.chunks_mut(stride.max(3)).zip(box_corners(least, greatest)) {
        vertex.iter_mut().zip(corner).for_each(|(word, number)| *word = number.to_bits());
    }
    vertices
}

/// Whether a corner in clip space is in front of the near plane. Clipping can then remove all samples of the box although the
/// object is visible. A NaN coordinate counts as clipped.
pub fn is_cut_by_near_plane(z: f32, w: f32) -> bool {
    !(z >= 0.0 && w > 0.0)
}
