//! The triangles of a scene on an adapter.
//!
//! Input: the words of vertices and indices. Output: two buffers, and the commands that draw them.

use std::num::NonZeroU32;
use std::ops::Range;

use fragbuf_frame::box_around;
use fragbuf_runtime::{ObjectBox, wgpu};

use crate::cli::attributes::Geometry;
use crate::cli::output::Failure;

/// The scene's vertices and indices on the device.
pub(super) struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    /// The indices of a draw.
    batch: u32,
    /// The indices of each object, and the box around it.
    objects: Vec<Range<u32>>,
    boxes: Vec<ObjectBox>,
}

impl Mesh {
    /// Uploads the triangles. `batch` is the number of those that one draw has; `None`: all.
    pub(super) fn upload(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        geometry: &Geometry,
        batch: Option<NonZeroU32>,
    ) -> Result<Self, Failure> {
        let buffer = |label: &str, words: &[u32], usage: wgpu::BufferUsages| {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            let (size, limit) = (bytes.len() as u64, device.limits().max_buffer_size);
            if size > limit {
                return Err(Failure::Device(format!(
                    "the scene's {label} need {size} bytes, and the device allows {limit}: use a smaller scene, or `--device cpu`"
                )));
            }
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            });
            queue.write_buffer(&buffer, 0, &bytes);
            Ok(buffer)
        };
        Ok(Mesh {
            vertices: buffer("vertices", &geometry.vertices, wgpu::BufferUsages::VERTEX)?,
            indices: buffer("indices", &geometry.indices, wgpu::BufferUsages::INDEX)?,
            count: geometry.indices.len() as u32,
            batch: batch.map_or(u32::MAX, |triangles| triangles.get().saturating_mul(3)),
            boxes: geometry.objects.iter().map(|object| box_of(geometry, object)).collect(),
            objects: geometry.objects.clone(),
        })
    }

    /// Draws the objects of these numbers; `None`: all.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, objects: Option<&[u32]>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        let visible = objects.filter(|_| !self.objects.is_empty());
        let Some(visible) = visible else { return self.draw_range(pass, 0..self.count) };
        for range in visible.iter().filter_map(|number| self.objects.get(*number as usize)) {
            self.draw_range(pass, range.clone());
        }
    }

    fn draw_range(&self, pass: &mut wgpu::RenderPass<'_>, range: Range<u32>) {
        let mut begin = range.start;
        while begin < range.end {
            let end = begin.saturating_add(self.batch).min(range.end);
            pass.draw_indexed(begin..end, 0, 0..1);
            begin = end;
        }
    }

    /// Returns the boxes of the objects, in the order of their numbers.
    pub(super) fn boxes(&self) -> &[ObjectBox] {
        &self.boxes
    }
}

/// Returns the box around the vertices that these indices name; all zeros if there are none.
fn box_of(geometry: &Geometry, indices: &Range<u32>) -> ObjectBox {
    let indices = geometry.indices.get(indices.start as usize..indices.end as usize).unwrap_or_default();
    let positions = indices.iter().filter_map(|index| {
        let words: &[u32; 3] = geometry.vertices.get(*index as usize * geometry.stride..)?.first_chunk()?;
        Some(words.map(f32::from_bits))
    });
    let (least, greatest) = box_around(positions).unwrap_or_default();
    ObjectBox { least, greatest }
}
