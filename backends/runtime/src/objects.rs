//! The caller's objects, by the boxes around them (D13 §3.3): geometry for a query of each, and which boxes no query can
//! judge.
//!
//! In: boxes in the space of vertex positions. Out: a vertex buffer, laid out as the vertex stage's own inputs, and indices.

use crate::Error;
use crate::words::to_bytes;
use crate::{VertexInputs, scope::scoped};

/// A box around an object: its least and its greatest corner, in the space of vertex positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectBox {
    /// The least coordinates.
    pub least: [f32; 3],
    /// The greatest.
    pub greatest: [f32; 3],
}

/// Boxes on the device.
pub(crate) struct Objects {
    boxes: Vec<ObjectBox>,
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
}

/// The faces of a box, two triangles each; bit 0, 1 and 2 of a corner's number say whether it is the greater along x, y and z.
const FACES: [u32; 36] =
    [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];

/// Corners of a box.
const CORNERS: usize = 8;

impl ObjectBox {
    fn corner(&self, number: usize) -> [f32; 3] {
        std::array::from_fn(|axis| if number >> axis & 1 == 1 { self.greatest[axis] } else { self.least[axis] })
    }

    /// Whether the box reaches to where the near plane cuts it away, so that none of its samples may pass although the object
    /// is seen. `camera` holds columns.
    pub(crate) fn crosses_near_plane(&self, camera: &[f32; 16]) -> bool {
        (0..CORNERS).any(|number| {
            let [x, y, z] = self.corner(number);
            let row = |row: usize| camera[row] * x + camera[4 + row] * y + camera[8 + row] * z + camera[12 + row];
            // Not a number is no place that could be dropped, either.
            !(row(2) >= 0.0 && row(3) > 0.0)
        })
    }
}

impl Objects {
    pub(crate) async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        inputs: &VertexInputs,
        boxes: &[ObjectBox],
    ) -> Result<Self, Error> {
        let stride = (inputs.stride / 4) as usize;
        let mut words = vec![0; boxes.len() * CORNERS * stride];
        let corners = boxes.iter().flat_map(|one| (0..CORNERS).map(|number| one.corner(number)));
        for (vertex, corner) in words.chunks_mut(stride.max(3)).zip(corners) {
            vertex.iter_mut().zip(corner).for_each(|(word, number)| *word = number.to_bits());
        }
        let buffer = |label: &str, words: &[u32], usage: wgpu::BufferUsages| {
            let size = 4 * words.len().max(4) as u64;
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            let label = Some(label);
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        let bytes = 4 * words.len() as u64;
        let make = || {
            let vertices = buffer("fragbuf boxes", &words, wgpu::BufferUsages::VERTEX);
            let indices = buffer("fragbuf boxes", &FACES, wgpu::BufferUsages::INDEX);
            queue.write_buffer(&vertices, 0, &to_bytes(&words));
            queue.write_buffer(&indices, 0, &to_bytes(&FACES));
            Objects { boxes: boxes.to_vec(), vertices, indices }
        };
        scoped(device, "the boxes of objects", bytes, make).await
    }

    pub(crate) fn boxes(&self) -> &[ObjectBox] {
        &self.boxes
    }

    /// Draws the box of one object.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, object: u32) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..FACES.len() as u32, (object * CORNERS as u32).cast_signed(), 0..1);
    }
}
