//! The boxes around the caller's objects (D13 §3.3), which occlusion queries draw, and the test for boxes that no query can
//! decide.
//!
//! Input: boxes in the space of vertex positions. Output: a vertex buffer in the layout of the vertex stage's inputs, and
//! indices.

use fragbuf_frame::{
    BOX_CORNERS, BOX_TRIANGLES, box_corners, box_vertices, grown_box, is_below_a_pixel, is_cut_by_near_plane,
};

use crate::error_scope::in_error_scope;
use crate::words::to_bytes;
use crate::{Error, VertexInputs};

/// A box around an object: its least and its greatest corner, in the space of vertex positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectBox {
    /// The least coordinates.
    pub least: [f32; 3],
    /// The greatest coordinates.
    pub greatest: [f32; 3],
}

/// Boxes on the device.
pub(crate) struct Objects {
    boxes: Vec<ObjectBox>,
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
}

impl ObjectBox {
    /// Whether no query can decide about the box: the near plane clips it, or it covers less than a pixel of a frame of `size`, so
    /// that possibly none of its samples passes although the object is visible. `camera` is in column order.
    pub(crate) fn is_undecided(&self, camera: &[f32; 16], size: (u32, u32)) -> bool {
        let (least, greatest) = grown_box(self.least, self.greatest);
        let corners = box_corners(least, greatest).map(|[x, y, z]| -> [f32; 4] {
            std::array::from_fn(|row| camera[row] * x + camera[4 + row] * y + camera[8 + row] * z + camera[12 + row])
        });
        corners.iter().any(|[_, _, z, w]| is_cut_by_near_plane(*z, *w)) || is_below_a_pixel(&corners, size)
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
        let vertices = |one: &ObjectBox| {
            let (least, greatest) = grown_box(one.least, one.greatest);
            box_vertices(least, greatest, stride)
        };
        let words: Vec<u32> = boxes.iter().flat_map(vertices).collect();
        let buffer = |label: &str, words: &[u32], usage: wgpu::BufferUsages| {
            let size = 4 * words.len().max(4) as u64;
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            let label = Some(label);
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        let bytes = 4 * words.len() as u64;
        let make = || {
            let vertices = buffer("fragbuf boxes", &words, wgpu::BufferUsages::VERTEX);
            let indices = buffer("fragbuf boxes", &BOX_TRIANGLES, wgpu::BufferUsages::INDEX);
            queue.write_buffer(&vertices, 0, &to_bytes(&words));
            queue.write_buffer(&indices, 0, &to_bytes(&BOX_TRIANGLES));
            Objects { boxes: boxes.to_vec(), vertices, indices }
        };
        in_error_scope(device, "the boxes of objects", bytes, make).await
    }

    pub(crate) fn boxes(&self) -> &[ObjectBox] {
        &self.boxes
    }

    /// Sets the buffers of the boxes.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Draws the box of one object, whose buffers are set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, object: u32) {
        pass.draw_indexed(0..BOX_TRIANGLES.len() as u32, (object * BOX_CORNERS as u32).cast_signed(), 0..1);
    }
}
