//! A target that can be read back.
//!
//! Use the format [`BLENDED`] if colours must be exact to 1/255. A driver may blend 8-bit targets in 8-bit arithmetic, which
//! rounds colour, alpha and product separately (lavapipe does, with an error of up to 1.1/255).

use crate::error_scope::in_error_scope;
use crate::{Error, Pending, block_on};

/// A format for exact blending. Every WebGPU device can blend it, and its steps are at most an eighth of an 8-bit target's.
pub const BLENDED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The bytes of a band: the rows that are read back at one time. At least one row is.
const BAND: u64 = 8 << 20;

/// A function from the words of a texel to its red, green, blue and alpha.
type DecodeTexel = fn(&[u32]) -> [f32; 4];

/// An image of one format and size on the device.
pub struct Offscreen {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// The buffer for the rows of a band, each at a multiple of 256 bytes.
    band: wgpu::Buffer,
    /// The rows of a band.
    rows: u32,
    texel: u32,
    padded: u32,
}

impl Offscreen {
    /// Creates a target of `width` × `height` pixels of an uncompressed colour format. Blocks.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, width: u32, height: u32) -> Result<Self, Error> {
        let bad = |name: &str, expected: &str| Error::BadValue { name: name.to_owned(), expected: expected.to_owned() };
        let texel = format.block_copy_size(None);
        let texel = texel.ok_or_else(|| bad("the target's format", "an uncompressed colour format"))?;
        let padded =
            width.checked_mul(texel).and_then(|row| row.checked_next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT));
        let padded = padded.ok_or_else(|| bad("the target's width", "so that a row has less than 4 GiB"))?;
        let rows = (BAND / u64::from(padded).max(1)).clamp(1, u64::from(height).max(1)) as u32;
        let bytes = u64::from(padded) * u64::from(rows);
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
            let band = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("fragbuf offscreen"),
                size: bytes,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (texture, view, band)
        };
        let size = u64::from(texel) * u64::from(width) * u64::from(height) + bytes;
        let (texture, view, band) = block_on(device, in_error_scope(device, "the offscreen target", size, make))??;
        Ok(Offscreen { texture, view, band, rows, texel, padded })
    }

    /// Returns the view to render into.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Reads the bytes of the image, row by row from the top, without padding. Submits and blocks.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<u8>, Error> {
        let mut bytes = Vec::new();
        self.for_each_row(device, queue, &mut |row| bytes.extend(row.iter().flat_map(|word| word.to_le_bytes())))?;
        // A row of texels of less than 4 bytes does not fill its words.
        let row = (self.texture.width() * self.texel) as usize;
        let words = row.next_multiple_of(4).max(1);
        if words != row {
            bytes = bytes.chunks(words).flat_map(|padded| padded.iter().copied().take(row)).collect();
        }
        Ok(bytes)
    }

    /// Reads red, green, blue and alpha of every pixel, row by row from the top, for the formats `Rgba8Unorm`, `Rgba16Float`
    /// and `Rgba32Float`. Needs little memory beside the result. Submits and blocks.
    pub fn colors(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<[f32; 4]>, Error> {
        let (words, decode): (usize, DecodeTexel) = match self.texture.format() {
            wgpu::TextureFormat::Rgba8Unorm => (1, |texel| {
                texel.first().map_or([0.0; 4], |word| word.to_le_bytes().map(|byte| f32::from(byte) / 255.0))
            }),
            wgpu::TextureFormat::Rgba16Float => (2, |texel| match *texel {
                [low, high] => [low, low >> 16, high, high >> 16].map(|half| half_to_float(half as u16)),
                _ => [0.0; 4],
            }),
            wgpu::TextureFormat::Rgba32Float => (4, |texel| match *texel {
                [r, g, b, a] => [r, g, b, a].map(f32::from_bits),
                _ => [0.0; 4],
            }),
            other => {
                return Err(Error::BadValue {
                    name: format!("the target's format, {other:?},"),
                    expected: "Rgba8Unorm, Rgba16Float or Rgba32Float".to_owned(),
                });
            }
        };
        let mut colors = Vec::with_capacity(self.texture.width() as usize * self.texture.height() as usize);
        self.for_each_row(device, queue, &mut |row| colors.extend(row.chunks_exact(words).map(decode)))?;
        Ok(colors)
    }

    /// Calls `row` with the words of every row from the top, without padding, band after band.
    fn for_each_row(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        row: &mut dyn FnMut(&[u32]),
    ) -> Result<(), Error> {
        let (padded, height) = (self.padded as usize / 4, self.texture.height());
        let words = (self.texture.width() * self.texel).div_ceil(4) as usize;
        for first in (0..height).step_by(self.rows as usize) {
            let rows = self.rows.min(height - first);
            let copy = || self.copy_band(device, queue, first, rows);
            let pending =
                block_on(device, in_error_scope(device, "the copy of the offscreen target", self.band.size(), copy))??;
            let band = pending.wait(device)?;
            band.chunks(padded.max(1)).take(rows as usize).for_each(|line| row(line.get(..words).unwrap_or(line)));
        }
        Ok(())
    }

    /// Submits the readback of some rows.
    fn copy_band(&self, device: &wgpu::Device, queue: &wgpu::Queue, first: u32, rows: u32) -> Pending<Vec<u32>> {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("fragbuf offscreen") };
        let mut encoder = device.create_command_encoder(&descriptor);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.padded), rows_per_image: None };
        let origin = wgpu::Origin3d { x: 0, y: first, z: 0 };
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo { origin, ..self.texture.as_image_copy() },
            wgpu::TexelCopyBufferInfo { buffer: &self.band, layout },
            wgpu::Extent3d { width: self.texture.width(), height: rows, depth_or_array_layers: 1 },
        );
        let pending = Pending::record(device, &mut encoder, &self.band, 0, self.band.size(), |words| words);
        queue.submit([encoder.finish()]);
        pending
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
