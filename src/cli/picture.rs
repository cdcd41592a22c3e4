//! Blends colours over a background, encodes them and writes them as a PNG.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use super::output::Failure;

/// Blends premultiplied linear colours over a background. Returns straight values from 0 to 1: linear, or sRGB with linear
/// alpha.
pub(crate) fn displayed(pixels: &[[f32; 4]], background: [f32; 4], linear: bool) -> Vec<[f32; 4]> {
    pixels.iter().map(|pixel| encoded(over(*pixel, background), linear)).collect()
}

/// Returns the straight colour of a premultiplied colour over a straight one.
fn over([r, g, b, a]: [f32; 4], [back_r, back_g, back_b, back_a]: [f32; 4]) -> [f32; 4] {
    let behind = (1.0 - a) * back_a;
    let alpha = a + behind;
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    [(r + behind * back_r) / alpha, (g + behind * back_g) / alpha, (b + behind * back_b) / alpha, alpha]
}

/// Encodes the colour channels and clamps them; alpha stays linear.
fn encoded([r, g, b, a]: [f32; 4], linear: bool) -> [f32; 4] {
    let channel = |value: f32| if linear { value.clamp(0.0, 1.0) } else { srgb(value.clamp(0.0, 1.0)) };
    [channel(r), channel(g), channel(b), a.clamp(0.0, 1.0)]
}

/// Encodes a linear value as sRGB (IEC 61966-2-1).
fn srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// Writes values from 0 to 1 to a PNG, as 8 bits each.
pub(crate) fn write(
    path: &Path,
    (width, height): (u32, u32),
    pixels: &[[f32; 4]],
    linear: bool,
) -> Result<(), Failure> {
    let bytes: Vec<u8> = pixels.iter().flatten().map(|value| (255.0 * value).round() as u8).collect();
    let failed = |error: &dyn std::fmt::Display| Failure::Files(format!("{}: {error}", path.display()));
    let file = File::create(path).map_err(|error| Failure::files(path, &error))?;
    let mut file = BufWriter::new(file);
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    if !linear {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    writer.write_image_data(&bytes).map_err(|error| failed(&error))?;
    writer.finish().map_err(|error| failed(&error))?;
    file.flush().map_err(|error| Failure::files(path, &error))
}
