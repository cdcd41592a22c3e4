//! Draws a scene of glass into a PNG file, by the means of Bevy or by a fragment buffer.
//!
//! `fragbuf-bevy OUT.png sorted`, `fragbuf-bevy OUT.png oit [NODES]`, or `fragbuf-bevy OUT.png FILE.fragbuf`. Prints the bytes, the lost
//! fragments and the time of a frame.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program prints")]

use std::path::Path;
use std::process::ExitCode;

use bevy::core_pipeline::oit::OrderIndependentTransparencySettings;
use fragbuf_bevy::demo::{Transparency, picture};
use fragbuf_bevy::{Error, FragmentBuffer};

const SIZE: [u32; 2] = [480, 360];

/// The frames that are measured.
const FRAMES: usize = 10;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let drawn = match *arguments.as_slice() {
        [out, "sorted"] => draw(out, Ok(Transparency::Sorted)),
        [out, "oit"] => draw(out, Ok(Transparency::Oit(OrderIndependentTransparencySettings::default()))),
        [out, "oit", nodes] => draw(out, oit(nodes)),
        [out, description] => draw(out, buffer(description)),
        _ => {
            eprintln!("usage: fragbuf-bevy OUT.png (sorted | oit [NODES] | FILE.fragbuf)");
            return ExitCode::from(2);
        }
    };
    match drawn {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns Bevy's transparency with this number of nodes per pixel, all of which it sorts.
fn oit(nodes: &str) -> Result<Transparency, Error> {
    let failed = |_| Error(format!("`{nodes}` is no number of nodes per pixel: write one from 1 to 64"));
    let nodes: u32 = nodes.parse().map_err(failed)?;
    if !(1..=64).contains(&nodes) {
        return Err(Error(format!("{nodes} nodes per pixel: write a number from 1 to 64")));
    }
    Ok(Transparency::Oit(OrderIndependentTransparencySettings {
        sorted_fragment_max_count: nodes,
        fragments_per_pixel_average: nodes as f32,
        alpha_threshold: 0.0,
    }))
}

fn buffer(path: &str) -> Result<Transparency, Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error(format!("{path}: {error}")))?;
    Ok(Transparency::Buffer(Box::new(FragmentBuffer::new(&text)?)))
}

fn draw(out: &str, transparency: Result<Transparency, Error>) -> Result<(), Error> {
    let picture = picture(transparency?, SIZE, FRAMES)?;
    write(Path::new(out), &picture.pixels)?;
    let lost = picture.lost.map_or("not counted".to_owned(), |lost| lost.to_string());
    println!(
        "bytes: {}; lost fragments: {lost}; ms per frame: {:.1}",
        picture.bytes,
        1e3 * picture.frame.as_secs_f64()
    );
    Ok(())
}

fn write(path: &Path, pixels: &[u8]) -> Result<(), Error> {
    let failed = |error: &dyn std::fmt::Display| Error(format!("{}: {error}", path.display()));
    let file = std::fs::File::create(path).map_err(|error| failed(&error))?;
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let bytes: Vec<u8> = pixels.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    writer.write_image_data(&bytes).map_err(|error| failed(&error))
}
