//! Draws overlapping glass panes with passes that `fragbuf generate` wrote:
//! `fragbuf-vulkan-host FOLDER out.png [--device NAME] [--validate]`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use fragbuf_follow::panes;
use fragbuf_vulkan_host::{Context, Error, Host, Scene, Settings, Validation};

const SIZE: [u32; 2] = [480, 320];

const USAGE: &str = "usage: fragbuf-vulkan-host FOLDER OUT.png [--device NAME] [--validate]
FOLDER: the output of `fragbuf generate … --target spirv`
NAME: a part of the name of a Vulkan device
--validate: load VK_LAYER_KHRONOS_validation, whose messages are errors";

fn main() -> ExitCode {
    let (mut paths, mut device, mut validation) = (Vec::new(), None, Validation::Off);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--validate" => validation = Validation::Synchronization,
            "--device" => device = Some(arguments.next().unwrap_or_default()),
            _ => paths.push(PathBuf::from(argument)),
        }
    }
    let is_named = device.as_ref().is_none_or(|name| !name.is_empty());
    let ([folder, out], true) = (paths.as_slice(), is_named) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match draw(folder, out, &Settings { device: device.as_deref(), validation, ..Settings::default() }) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw(folder: &Path, out: &Path, settings: &Settings<'_>) -> Result<(), Error> {
    let read = |path: &str| {
        let path = folder.join(path);
        std::fs::read(&path).map_err(|error| Error(format!("{}: {error}", path.display())))
    };
    let manifest =
        String::from_utf8(read("manifest.json")?).map_err(|error| Error(format!("manifest.json: {error}")))?;
    let context = Context::open(settings)?;
    let mut host = Host::new(&context, &manifest, &read, SIZE)?;
    // Pools that no step sizes hold every pane over every pixel.
    host.set_symbol("fragments", panes::DEEPEST * u64::from(SIZE[0] * SIZE[1]))?;
    let (vertices, objects) = (panes::vertices(host.vertex_inputs(), SIZE), panes::objects());
    let identity = std::array::from_fn(|index| if index % 5 == 0 { 1.0 } else { 0.0 });
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: identity };
    let image = host.render(&scene, [1.0; 4])?.without_losses()?;
    let bytes: Vec<u8> = image.pixels.iter().flatten().map(|channel| (channel * 255.0).round() as u8).collect();
    let file = std::fs::File::create(out).map_err(|error| Error(format!("{}: {error}", out.display())))?;
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgba);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes));
    written.map_err(|error| Error(format!("{}: {error}", out.display())))
}
