//! A target that can be read back.
//!
//! Use the format [`BLENDED`] if colours must be exact to 1/255. A driver may blend 8-bit targets in 8-bit arithmetic, which
//! rounds colour, alpha and product separately (lavapipe does, with an error of up to 1.1/255).

use crate::error_scope::in_error_scope;
use crate::words::from_bytes;
use crate::{Error, Pending, block_on};

/// A format for exact blending. Every WebGPU device can blend it, and its steps are at most an eighth of an 8-bit target's.
pub const BLENDED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// An image of one format and size on the device.
pub struct Offscreen {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// The buffer for copied rows, each at a multiple of 256 bytes.
    rows: wgpu::Buffer,
    texel: u32,
    padded: u32,
}

impl Offscreen {
    /// Creates a target of `width` × `height` pixels of an uncompressed colour format. Blocks.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, width: u32, height: u32) -> Result<Self, Error> {
        let texel = format.block_copy_size(None).ok_or_else(|| Error::BadValue {
            name: "the target's format".to_owned(),
            expected: "an uncompressed colour format".to_owned(),
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
        let (texture, view, rows) = block_on(device, in_error_scope(device, "the offscreen target", bytes, make))??;
        Ok(Offscreen { texture, view, rows, texel, padded })
    }

    /// Returns the view to render into.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Reads the bytes of the image, row by row from the top, without padding. Submits and blocks.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<u8>, Error> {
        let copy = || {
            let descriptor = wgpu::CommandEncoderDescriptor { label: Some("fragbuf offscreen") };
            let mut encoder = device.create_command_encoder(&descriptor);
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.padded), rows_per_image: None };
            encoder.copy_texture_to_buffer(
                self.texture.as_image_copy(),
                wgpu::TexelCopyBufferInfo { buffer: &self.rows, layout },
                self.texture.size(),
            );
            let pending = Pending::record(device, &mut encoder, &self.rows, 0, self.rows.size(), |words| words);
            queue.submit([encoder.finish()]);
            pending
        };
        let pending =
            block_on(device, in_error_scope(device, "the copy of the offscreen target", self.rows.size(), copy))??;
        let bytes: Vec<u8> = pending.wait(device)?.into_iter().flat_map(u32::to_le_bytes).collect();
        let row = (self.texture.width() * self.texel) as usize;
        Ok(bytes.chunks(self.padded as usize).flat_map(|padded| padded.iter().copied().take(row)).collect())
    }

    /// Reads red, green, blue and alpha of every pixel, row by row from the top, for the formats `Rgba8Unorm`, `Rgba16Float`
    /// and `Rgba32Float`. Submits and blocks.
    pub fn colors(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<[f32; 4]>, Error> {
        let channels: Vec<f32> = match self.texture.format() {
            wgpu::TextureFormat::Rgba8Unorm => {
                self.read(device, queue)?.into_iter().map(|byte| f32::from(byte) / 255.0).collect()
            }
            wgpu::TextureFormat::Rgba16Float => {
                let bytes = self.read(device, queue)?;
                bytes.chunks_exact(2).map(|half| half_to_float(u16::from_le_bytes([half[0], half[1]]))).collect()
            }
            wgpu::TextureFormat::Rgba32Float => {
                from_bytes(&self.read(device, queue)?).into_iter().map(f32::from_bits).collect()
            }
            other => {
                return Err(Error::BadValue {
                    name: format!("the target's format, {other:?},"),
                    expected: "Rgba8Unorm, Rgba16Float or Rgba32Float".to_owned(),
                });
            }
        };
        Ok(channels.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect())
    }
}

/// Converts IEEE 754 binary16 to binary32, exactly.
fn half_to_float(half: u16) -> f32 {
    let sign = u32::from(half >> 15) << 31;
    let (exponent, fraction) = (u32::from(half >> 10 & 31), u32::from(half & 1023));
    match exponent {
        // Zero and subnormals: fraction · 2⁻²⁴.
        0 => f32::from_bits(sign | (fraction as f32 / 16_777_216.0).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

#[cfg(test)]
mod tests {
    use super::half_to_float;

    #[test]
    fn half_floats_convert_exactly() {
        let halves = [0x3c00, 0xc000, 0x3555, 0x0001, 0x7bff, 0x0000];
        let floats = [1.0, -2.0, 0.333_251_95, 5.960_464_5e-8, 65504.0, 0.0];
        assert_eq!(halves.map(half_to_float), floats);
        assert_eq!(half_to_float(0x7c00), f32::INFINITY);
    }
}
