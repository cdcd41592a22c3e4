//! Images as numbers.
//!
//! Input: a PNG. Output: four channels per pixel from 0 to 1, as stored: no colour space is converted.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::memory::Budget;
use super::output::Failure;

/// The pixels of an image.
pub(crate) struct ImageFile {
    /// Width and height.
    pub(crate) size: (u32, u32),
    /// Row after row from the top. Grey images have three equal channels, images without alpha the alpha 1.
    pub(crate) texels: Vec<[f32; 4]>,
    /// The memory that is left beside it.
    pub(crate) memory: Budget,
}

impl ImageFile {
    /// Returns the pixels of the first row.
    pub(crate) fn first_row(mut self) -> Vec<[f32; 4]> {
        self.texels.truncate(self.size.0 as usize);
        self.texels
    }
}

/// The bytes per pixel: at most four channels of 16 bits, the numbers, and the texture of a device.
const BYTES: u64 = 8 + 16 + 16;

/// Reads an image.
pub(crate) fn read_image(path: &Path, memory: Budget) -> Result<ImageFile, Failure> {
    let unreadable = |error: png::DecodingError| Failure::Files(format!("{}: {error}", path.display()));
    let file = File::open(path).map_err(|error| Failure::files(path, &error))?;
    let limits = png::Limits { bytes: usize::try_from(memory.left()).unwrap_or(usize::MAX) };
    let mut decoder = png::Decoder::new_with_limits(BufReader::new(file), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(unreadable)?;
    let size = (reader.info().width, reader.info().height);
    let memory = memory.without(u64::from(size.0) * u64::from(size.1) * BYTES, "the pixels of an image")?;
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
    let info = reader.next_frame(&mut bytes).map_err(unreadable)?;
    let numbers: Vec<f32> = match info.bit_depth {
        png::BitDepth::Sixteen => {
            bytes.chunks_exact(2).map(|pair| f32::from(u16::from_be_bytes([pair[0], pair[1]])) / 65_535.0).collect()
        }
        _ => bytes.iter().map(|byte| f32::from(*byte) / 255.0).collect(),
    };
    let texel = |channels: &[f32]| match channels {
        [grey] => [*grey, *grey, *grey, 1.0],
        [grey, alpha] => [*grey, *grey, *grey, *alpha],
        [red, green, blue] => [*red, *green, *blue, 1.0],
        [red, green, blue, alpha, ..] => [*red, *green, *blue, *alpha],
        [] => [0.0; 4],
    };
    let texels = numbers.chunks_exact(info.color_type.samples()).map(texel).collect();
    Ok(ImageFile { size, texels, memory })
}
