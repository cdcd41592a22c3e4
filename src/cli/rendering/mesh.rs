//! The triangles of a scene on an adapter.
//!
//! Input: the words of vertices and indices. Output: two buffers, and the commands that draw them.

use std::num::NonZeroU32;

use fragbuf_runtime::wgpu;

use crate::cli::attributes::Geometry;
use crate::cli::output::Failure;

/// The scene's vertices and indices on the device.
pub(super) struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    /// The indices of a draw.
    batch: u32,
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
        })
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut begin = 0;
        while begin < self.count {
            let end = begin.saturating_add(self.batch).min(self.count);
            pass.draw_indexed(begin..end, 0, 0..1);
            begin = end;
        }
    }
}
