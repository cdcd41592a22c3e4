//! The uniform buffers: the frame's, the description's own, the camera's.

use fragbuf_codegen::Plan;

/// The uniform buffers.
pub(crate) struct Blocks {
    pub(crate) frame: wgpu::Buffer,
    pub(crate) own: wgpu::Buffer,
    pub(crate) camera: wgpu::Buffer,
    /// Bound where a pass touches nothing.
    pub(crate) filler: wgpu::Buffer,
}

impl Blocks {
    pub(crate) fn new(device: &wgpu::Device, plan: &Plan, uniforms: &[u32]) -> Self {
        let block = |label: &str, words: usize| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: 4 * words.max(1).next_multiple_of(4) as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Blocks {
            frame: block("fragbuf frame", plan.frame.len()),
            own: block("fragbuf uniforms", uniforms.len()),
            camera: block("fragbuf camera", IDENTITY.len()),
            filler: block("fragbuf nothing", 0),
        }
    }
}

/// The camera before any is set: positions are clip space.
pub(crate) const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
