//! The triangles of a scene on an adapter.
//!
//! Input: the words of vertices and indices. Output: two buffers, and the commands that draw them.

use std::num::NonZeroU32;
use std::ops::Range;

use fragbuf_frame::box_around;
use fragbuf_runtime::{Call, DrawArguments, ObjectBox, SceneDraw, wgpu};

use crate::cli::attributes::Geometry;
use crate::cli::output::Failure;

/// The scene's vertices and indices on the device.
pub(super) struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    draws: Vec<SceneDraw>,
    /// The box around each object.
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
            draws: draws(geometry, batch.map_or(u32::MAX, |triangles| triangles.get().saturating_mul(3))),
            boxes: geometry.objects.iter().map(|object| box_of(geometry, object)).collect(),
        })
    }

    /// Draws the objects that the call asks for.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, call: &Call<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for number in 0..self.draws.len() {
            // The renderer has these draws.
            call.draw(pass, number).ok();
        }
    }

    /// Returns the draws of the scene.
    pub(super) fn draws(&self) -> &[SceneDraw] {
        &self.draws
    }

    /// Returns the boxes of the objects, in the order of their numbers.
    pub(super) fn boxes(&self) -> &[ObjectBox] {
        &self.boxes
    }
}

/// Returns the draws of all objects, each of at most `batch` indices. A scene without objects is one.
fn draws(geometry: &Geometry, batch: u32) -> Vec<SceneDraw> {
    let whole = 0..geometry.indices.len() as u32;
    let objects = if geometry.objects.is_empty() { std::slice::from_ref(&whole) } else { &geometry.objects };
    let mut draws = Vec::new();
    for (object, range) in (0..).zip(objects) {
        let mut first_index = range.start;
        while first_index < range.end {
            let end = first_index.saturating_add(batch).min(range.end);
            let arguments = wgpu::util::DrawIndexedIndirectArgs {
                index_count: end - first_index,
                instance_count: 1,
                first_index,
                base_vertex: 0,
                first_instance: 0,
            };
            draws.push(SceneDraw { object, arguments: DrawArguments::Indexed(arguments) });
            first_index = end;
        }
    }
    draws
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
