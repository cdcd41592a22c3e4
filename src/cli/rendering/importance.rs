//! The importance of pixels, from the image of `--importance`: black is 0, white is 1.
//!
//! Input: a PNG of the size of the frame. Output: a number per pixel, row after row from the top. Colours count by the mean of their
//! channels, as stored; alpha does not count.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

#[cfg(feature = "gpu")]
use fragbuf_runtime::wgpu;

use crate::cli::memory::Budget;
use crate::cli::output::Failure;

/// The importance of every pixel.
pub(super) struct Importance {
    pub(super) values: Vec<f32>,
    /// The memory that is left beside it.
    pub(super) memory: Budget,
}

/// The bytes per pixel: the image, a number per pixel, and the texture of a device.
const BYTES: u64 = 4 + 4 + 4;

impl Importance {
    /// Reads an image. It must have the size of the frame.
    pub(super) fn read(path: &Path, (width, height): (u32, u32), memory: Budget) -> Result<Self, Failure> {
        let memory = memory.without(u64::from(width) * u64::from(height) * BYTES, "the importance of pixels")?;
        let unreadable = |error: png::DecodingError| Failure::Files(format!("{}: {error}", path.display()));
        let file = File::open(path).map_err(|error| Failure::files(path, &error))?;
        let limits = png::Limits { bytes: usize::try_from(memory.left()).unwrap_or(usize::MAX) };
        let mut decoder = png::Decoder::new_with_limits(BufReader::new(file), limits);
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(unreadable)?;
        let found = (reader.info().width, reader.info().height);
        if found != (width, height) {
            return Err(Failure::Files(format!(
                "{}: the importance has {} x {} pixels, and the image {width} x {height}: give both one size",
                path.display(),
                found.0,
                found.1
            )));
        }
        let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
        let info = reader.next_frame(&mut bytes).map_err(unreadable)?;
        let channels = info.color_type.samples();
        let colors = if channels >= 3 { 3 } else { 1 };
        let value = |pixel: &[u8]| {
            let sum: u32 = pixel.iter().take(colors).map(|channel| u32::from(*channel)).sum();
            sum as f32 / (255.0 * colors as f32)
        };
        Ok(Importance { values: bytes.chunks_exact(channels).map(value).collect(), memory })
    }
}

#[cfg(feature = "gpu")]
impl Importance {
    /// Creates a texture with the importance.
    pub(super) fn upload(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (width, height): (u32, u32),
    ) -> wgpu::Texture {
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("importance"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let bytes: Vec<u8> = self.values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
        texture
    }
}
