//! Clears buffers to words other than zero, by copies from a buffer filled with the word: WebGPU clears only to zero.

use fragbuf_codegen::{Action, Plan, PlannedResource};

use crate::words;

/// The bytes that one copy of a pattern clears.
pub(crate) const PATTERN: u64 = 1 << 16;

/// Creates a filled buffer for each word other than zero that a step clears a buffer to.
pub(crate) fn patterns(device: &wgpu::Device, plan: &Plan) -> Vec<(u32, wgpu::Buffer)> {
    let mut patterns: Vec<(u32, wgpu::Buffer)> = Vec::new();
    for command in &plan.frame.commands {
        let Action::Clear { resource, value } = command.action else { continue };
        let planned = plan.resources.get(resource.0);
        let is_texture = planned.is_some_and(PlannedResource::is_texture);
        if value == 0 || is_texture || patterns.iter().any(|(known, _)| *known == value) {
            continue;
        }
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("fragbuf clear"),
            size: PATTERN,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: true,
        });
        if let Ok(mut view) = buffer.get_mapped_range_mut(..) {
            view.copy_from_slice(&words::to_bytes(&vec![value; PATTERN as usize / 4]));
        }
        buffer.unmap();
        patterns.push((value, buffer));
    }
    patterns
}
