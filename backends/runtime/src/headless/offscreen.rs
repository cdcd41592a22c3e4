//! A target that can be read back.

use crate::scope::scoped;
use crate::{Error, Pending, block_on};

/// A picture of one format and size on the device.
pub struct Offscreen {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Where rows are copied to, each at a multiple of 256 bytes.
    rows: wgpu::Buffer,
    texel: u32,
    padded: u32,
}

impl Offscreen {
    /// A target of `width` × `height` pixels of an uncompressed colour format. Blocks.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, width: u32, height: u32) -> Result<Self, Error> {
        let texel = format.block_copy_size(None).ok_or_else(|| Error::BadValue {
            name: "the target's format".to_owned(),
            wanted: "an uncompressed colour format".to_owned(),
        })?;
        let padded = (width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(padded) * u64::from(height);
        let make = || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("fragbuf offscreen"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            let rows = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("fragbuf offscreen"),
                size: bytes,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (texture, view, rows)
        };
        let (texture, view, rows) = block_on(device, scoped(device, "the offscreen target", bytes, make))??;
        Ok(Offscreen { texture, view, rows, texel, padded })
    }

    /// What to render into.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The bytes of the picture, row after row from the top, without padding. Submits and blocks.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<u8>, Error> {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("fragbuf offscreen") });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.padded), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.rows, layout },
            self.texture.size(),
        );
        let pending = Pending::record(device, &mut encoder, &self.rows, 0, self.rows.size(), |words| words);
        queue.submit([encoder.finish()]);
        let bytes: Vec<u8> = pending.wait(device)?.into_iter().flat_map(u32::to_le_bytes).collect();
        let row = (self.texture.width() * self.texel) as usize;
        Ok(bytes.chunks(self.padded as usize).flat_map(|padded| padded.iter().copied().take(row)).collect())
    }
}
