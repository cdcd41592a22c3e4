//! The uniform buffers of the description and of the camera. The blocks of a frame's slices are allocated with its memory.

/// The uniform buffers.
pub(crate) struct UniformBuffers {
    /// The description's uniforms.
    pub(crate) description: wgpu::Buffer,
    pub(crate) camera: wgpu::Buffer,
    /// Bound at bindings that a pass does not use.
    pub(crate) filler: wgpu::Buffer,
}

impl UniformBuffers {
    pub(crate) fn new(device: &wgpu::Device, uniforms: &[u32]) -> Self {
        UniformBuffers {
            description: create(device, "fragbuf uniforms", uniforms.len()),
            camera: create(device, "fragbuf camera", IDENTITY.len()),
            filler: create(device, "fragbuf nothing", 0),
        }
    }
}

/// Creates a uniform buffer of at least `words` words.
fn create(device: &wgpu::Device, label: &str, words: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: 4 * words.max(1).next_multiple_of(4) as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The initial camera: positions are in clip space.
pub(crate) const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
