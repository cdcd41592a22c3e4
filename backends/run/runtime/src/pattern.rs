//! Clears to something else than zero, by copies from a buffer full of the word: WebGPU has no other.

use fragbuf_codegen::{Action, Plan};
use fragbuf_templates::vocabulary::Element;

use crate::words;

/// Bytes that one copy of a pattern clears.
pub(crate) const PATTERN: u64 = 1 << 16;

/// A buffer full of each word that some step clears a buffer to, zero apart.
pub(crate) fn patterns(device: &wgpu::Device, plan: &Plan) -> Vec<(u32, wgpu::Buffer)> {
    let mut patterns: Vec<(u32, wgpu::Buffer)> = Vec::new();
    for command in &plan.frame.commands {
        let Action::Clear { resource, value } = command.action else { continue };
        let planned = plan.resources.get(resource.0);
        let is_texture = planned.is_some_and(|planned| matches!(planned.resource.element, Element::Texture(_)));
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
