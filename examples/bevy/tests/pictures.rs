//! The picture of the guide is what the program draws, and the guide's example draws glass. `INSTA_UPDATE=always` updates the picture.

use std::path::{Path, PathBuf};

use bevy::camera::RenderTarget;
use bevy::core_pipeline::oit::OrderIndependentTransparencySettings;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use fragbuf_bevy::demo::{Transparency, picture};
use fragbuf_bevy::headless::{app, image_texels, ready, target};
use fragbuf_bevy::{FragmentBuffer, FragmentBufferPlugin, FragmentCounters};

use crate::glass;
use crate::techniques::alone;

/// The size of each of the three parts.
const SIZE: [u32; 2] = [360, 270];

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn buffer() -> FragmentBuffer {
    let text = std::fs::read_to_string(folder().join("glass.fragbuf")).unwrap();
    FragmentBuffer::new(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// Draws the scene in three ways.
fn parts() -> [Vec<u8>; 3] {
    let ways = [
        Transparency::Sorted,
        Transparency::Oit(OrderIndependentTransparencySettings::default()),
        Transparency::Buffer(Box::new(buffer())),
    ];
    ways.map(|way| picture(way, SIZE, 1).unwrap_or_else(|error| panic!("{error}")).pixels)
}

/// Puts parts beside each other, without alpha.
fn beside(parts: &[Vec<u8>]) -> Vec<u8> {
    let rows = (0..SIZE[1] as usize).flat_map(|row| parts.iter().map(move |part| (row, part)));
    let row_bytes = 4 * SIZE[0] as usize;
    let texels = rows.flat_map(|(row, part)| part[row * row_bytes..(row + 1) * row_bytes].chunks_exact(4));
    texels.flat_map(|texel| texel[..3].to_vec()).collect()
}

fn write(path: &Path, bytes: &[u8]) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), 3 * SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
}

fn read(path: &PathBuf) -> Vec<u8> {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!([info.width, info.height], [3 * SIZE[0], SIZE[1]]);
    bytes
}

/// The number of channels that differ by more than a rounding of eight bits.
fn different(one: &[u8], other: &[u8]) -> usize {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).filter(|(one, other)| one.abs_diff(**other) > 2).count()
}

#[test]
fn the_guide_shows_what_the_program_draws() {
    let _guard = alone();
    let parts = parts();
    let path = folder().join("glass.png");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        write(&path, &beside(&parts));
    }
    let (drawn, shown) = (beside(&parts), read(&path));
    // Where a pool of Bevy's has no slot, the order in which tiles are drawn decides what is lost.
    let row = 3 * SIZE[0] as usize;
    let of = |bytes: &[u8], part: usize| -> Vec<u8> {
        bytes.chunks_exact(3 * row).flat_map(|pixels| pixels[part * row..(part + 1) * row].to_vec()).collect()
    };
    for part in [0, 2] {
        let count = different(&of(&drawn, part), &of(&shown, part));
        assert!(
            count < row * SIZE[1] as usize / 500,
            "part {part} of glass.png: {count} channels differ; INSTA_UPDATE=always updates it"
        );
    }
    // With a node per fragment, Bevy's picture differs from that of the buffer at edges alone, which have no samples there.
    let settings = OrderIndependentTransparencySettings {
        sorted_fragment_max_count: 32,
        fragments_per_pixel_average: 32.0,
        alpha_threshold: 0.0,
    };
    let whole = picture(Transparency::Oit(settings), SIZE, 1).unwrap_or_else(|error| panic!("{error}")).pixels;
    let (near, far) = (different(&whole, &parts[2]), different(&parts[1], &parts[2]));
    println!("{near} channels differ from Bevy's picture with a node per fragment, {far} from that with its default");
    assert!(near < whole.len() / 20 && far > whole.len() / 5, "{near} and {far} of {} channels", whole.len());
}

#[test]
fn the_example_draws_glass() {
    let _guard = alone();
    let mut app = app();
    app.add_plugins(FragmentBufferPlugin).add_systems(Startup, glass::setup);
    ready(&mut app).unwrap_or_else(|error| panic!("{error}"));
    let image = target(&mut app, [64, 48], wgpu::TextureFormat::Rgba8UnormSrgb);
    app.update();
    let mut cameras = app.world_mut().query_filtered::<Entity, With<FragmentBuffer>>();
    let camera = cameras.single(app.world()).unwrap();
    // The default of tone mapping needs a table that this build of Bevy leaves out.
    app.world_mut().entity_mut(camera).insert((RenderTarget::Image(image.clone().into()), Tonemapping::AcesFitted));
    for _ in 0..8 {
        app.update();
    }
    let counters = app.world().get::<FragmentCounters>(camera).cloned().unwrap_or_default();
    assert!(counters.bytes > 0 && counters.counters.lost == 0, "{counters:?}");
    let pixels = image_texels(&app, &image).unwrap_or_else(|error| panic!("{error}"));
    let background = pixels.chunks_exact(4).filter(|pixel| *pixel == &pixels[..4]).count();
    assert!((500..2900).contains(&background), "{background} of 3072 pixels show no glass");
}
