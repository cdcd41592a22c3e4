//! What a caller draws: a scene of objects, and the boxes around them that occlusion queries draw.

use std::collections::BTreeMap;

use crate::Error;

/// The corners of a box as triangles: bit 0 selects x, bit 1 y and bit 2 z of the greatest corner.
pub const BOX: [usize; 36] =
    [0, 1, 2, 2, 1, 3, 4, 6, 5, 5, 6, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 6, 3, 7, 0, 2, 4, 4, 2, 6, 1, 5, 3, 3, 5, 7];

/// A scene: vertices as the vertex inputs lie one after the other, and objects in the order of drawing.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The bytes of all vertices.
    pub vertices: &'a [u8],
    /// The objects.
    pub objects: &'a [Object],
    /// From model space to clip space, column by column.
    pub view_projection: [f32; 16],
}

/// Vertices of a scene that are drawn, or not drawn, together.
#[derive(Clone, Copy, Debug)]
pub struct Object {
    /// The first vertex.
    pub first: u32,
    /// The number of vertices, three per triangle.
    pub count: u32,
    /// The least and the greatest corner of the object's box.
    pub bounds: [[f32; 3]; 2],
}

/// An image: red, green, blue and alpha, row by row from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// The pixels.
    pub pixels: Vec<[f32; 4]>,
    /// The counters of the frame, by name.
    pub counters: BTreeMap<String, u64>,
    /// The sum of the counters of losses, `is_loss` in the manifest. If it is not 0, the image is or may be wrong:
    /// fragments are missing, were composited in another order, or cover pixels partly where whole pixels are required.
    pub lost: u64,
}

impl Image {
    /// Returns the image, or an error if it is or may be wrong.
    pub fn without_losses(self) -> Result<Self, Error> {
        if self.lost == 0 {
            return Ok(self);
        }
        let counted = self.counters.iter().filter(|(_, count)| **count > 0);
        let counters: Vec<String> = counted.map(|(name, count)| format!("{name} {count}")).collect();
        Err(Error(format!(
            "the image is or may be wrong: its counters of losses add up to {} ({}). The guide's chapter `counters` \
             explains what to change",
            self.lost,
            counters.join(", ")
        )))
    }
}

impl Object {
    /// Returns a corner of the object's box. The box is larger by 1/64 of its greatest extent at each side, so that
    /// no object is dropped because a rasteriser rounds positions.
    pub fn corner(&self, corner: usize) -> [f32; 3] {
        let [least, greatest] = self.bounds;
        let margin = (0..3).map(|axis| greatest[axis] - least[axis]).fold(0.0, f32::max) / 64.0;
        std::array::from_fn(|axis| if corner >> axis & 1 == 1 { greatest[axis] + margin } else { least[axis] - margin })
    }

    /// Tests whether a query of the object's box decides about the object. It does not if the near plane, z = 0 in
    /// clip space, may clip every sample of the box away, or if the box covers less than a pixel, so that possibly no
    /// sample lies in it.
    pub fn is_decidable(&self, matrix: &[f32; 16], [width, height]: [u32; 2]) -> bool {
        let row = |row: usize, [x, y, z]: [f32; 3]| {
            matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row]
        };
        let corners: [[f32; 4]; 8] = std::array::from_fn(|corner| {
            let corner = self.corner(corner);
            std::array::from_fn(|axis| row(axis, corner))
        });
        let extent = |axis: usize, pixels: u32| {
            let places = corners.map(|corner| corner[axis] / corner[3] * pixels as f32 / 2.0);
            places.iter().copied().fold(f32::MIN, f32::max) - places.iter().copied().fold(f32::MAX, f32::min)
        };
        let is_before = |corner: &[f32; 4]| corner[2] < 0.0 || corner[3] <= 0.0;
        !corners.iter().any(is_before) && (extent(0, width) >= 1.0 || extent(1, height) >= 1.0)
    }
}

impl Scene<'_> {
    /// Returns the boxes of all objects, 36 vertices each, in the layout of the scene's vertices. The position comes
    /// first; other inputs are 0.
    pub fn boxes(&self, stride: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        for corner in self.objects.iter().flat_map(|object| BOX.map(|corner| object.corner(corner))) {
            let mut vertex: Vec<u8> = corner.iter().flat_map(|value| value.to_le_bytes()).collect();
            vertex.resize(stride, 0);
            bytes.extend(vertex);
        }
        bytes
    }
}
