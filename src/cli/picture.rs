//! Blends colours over a background, encodes them and writes them as a PNG, pixel by pixel: there is no second image in memory.

use std::fs::File;
use std::io::{BufWriter, ErrorKind, IsTerminal as _, Write};
use std::path::Path;

use super::output::Failure;

/// Blends a premultiplied linear colour over a background. Returns straight values from 0 to 1: linear, or sRGB with linear
/// alpha.
pub(crate) fn displayed(pixel: [f32; 4], background: [f32; 4], linear: bool) -> [f32; 4] {
    encoded(over(pixel, background), linear)
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

/// Tests whether a path of `--out` is stdout.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Writes values from 0 to 1 to a PNG, as 8 bits each: those of one pixel after the other, row by row from the top.
pub(crate) fn write(
    path: &Path,
    (width, height): (u32, u32),
    pixels: &mut dyn Iterator<Item = [f32; 4]>,
    linear: bool,
) -> Result<(), Failure> {
    let file: Box<dyn Write> = if is_stdout(path) {
        if std::io::stdout().is_terminal() {
            return Err(Failure::Usage(
                "a terminal does not show a PNG: redirect stdout, or give a file to `--out`".to_owned(),
            ));
        }
        Box::new(std::io::stdout().lock())
    } else {
        Box::new(File::create(path).map_err(|error| Failure::files(path, &error))?)
    };
    match encode(&mut BufWriter::new(file), (width, height), pixels, linear) {
        // A reader that has seen enough, such as `head`, is no failure.
        Err(EncodeError::Write(error)) if is_stdout(path) && error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(EncodeError::Write(error)) => Err(Failure::files(path, &error)),
        Err(EncodeError::Encoding(error)) => Err(Failure::Files(format!("{}: {error}", path.display()))),
        Ok(()) => Ok(()),
    }
}

/// Returns a PNG as bytes. The pixels are those of [`write`].
#[cfg(any(feature = "figures", feature = "playground"))]
pub(crate) fn bytes(
    size: (u32, u32),
    pixels: &mut dyn Iterator<Item = [f32; 4]>,
    linear: bool,
) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    encode(&mut bytes, size, pixels, linear).map_err(|error| match error {
        EncodeError::Write(error) => Failure::Files(error.to_string()),
        EncodeError::Encoding(error) => Failure::Files(error.to_string()),
    })?;
    Ok(bytes)
}

/// Why a PNG was not written.
enum EncodeError {
    Write(std::io::Error),
    Encoding(png::EncodingError),
}

impl From<png::EncodingError> for EncodeError {
    fn from(error: png::EncodingError) -> Self {
        EncodeError::Encoding(error)
    }
}

/// Returns an encoder of red, green, blue and alpha in 8 bits each.
pub(super) fn encoder<W: Write>(file: W, (width, height): (u32, u32), linear: bool) -> png::Encoder<'static, W> {
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    if !linear {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    encoder
}

/// Returns a value from 0 to 1 in 8 bits.
pub(super) fn byte(value: f32) -> u8 {
    (255.0 * value).round() as u8
}

/// Writes the pixels as a PNG.
fn encode(
    file: &mut dyn Write,
    (width, height): (u32, u32),
    pixels: &mut dyn Iterator<Item = [f32; 4]>,
    linear: bool,
) -> Result<(), EncodeError> {
    let mut writer = encoder(&mut *file, (width, height), linear).write_header()?;
    let mut stream = writer.stream_writer()?;
    let mut row = Vec::with_capacity(4 * width as usize);
    for _ in 0..height {
        row.clear();
        row.extend(pixels.take(width as usize).flatten().map(byte));
        stream.write_all(&row).map_err(EncodeError::Write)?;
    }
    stream.finish()?;
    writer.finish()?;
    file.flush().map_err(EncodeError::Write)
}
