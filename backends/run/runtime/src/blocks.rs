//! The uniform buffers: the description's own and the camera's. Those of a frame's slices are made with its memory.

/// The uniform buffers.
pub(crate) struct Blocks {
    pub(crate) own: wgpu::Buffer,
    pub(crate) camera: wgpu::Buffer,
    /// Bound where a pass touches nothing.
    pub(crate) filler: wgpu::Buffer,
}

impl Blocks {
    pub(crate) fn new(device: &wgpu::Device, uniforms: &[u32]) -> Self {
        Blocks {
            own: block(device, "fragbuf uniforms", uniforms.len()),
            camera: block(device, "fragbuf camera", IDENTITY.len()),
            filler: block(device, "fragbuf nothing", 0),
        }
    }
}

/// A uniform buffer of so many words.
pub(crate) fn block(device: &wgpu::Device, label: &str, words: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: 4 * words.max(1).next_multiple_of(4) as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The camera before any is set: positions are clip space.
pub(crate) const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
