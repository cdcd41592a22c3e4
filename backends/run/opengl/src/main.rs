//! Draws overlapping glass panes with passes that `fragbuf generate` wrote. The guide's chapter `opengl` uses it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use fragbuf_follow::panes;
use fragbuf_opengl_host::{Api, Context, Error, Host, Image, Material, Scene, VertexInput};

const USAGE: &str = "usage: fragbuf-opengl-host [--es] [--material VERTEX FRAGMENT] FOLDER OUT.png
FOLDER: the output of `fragbuf generate … --target glsl`, with `--es` of `--target glsl-es`, with `--material` in `--form module`
VERTEX, FRAGMENT: shaders in GLSL without `#version`, with the vertex inputs `position` and `color` at locations 0 and 1";

const SIZE: [u32; 2] = [480, 360];

/// The command line.
struct Arguments {
    api: Api,
    material: Option<[PathBuf; 2]>,
    folder: PathBuf,
    out: PathBuf,
}

fn main() -> ExitCode {
    let Some(arguments) = parse(std::env::args_os().skip(1).map(PathBuf::from)) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match draw(&arguments).and_then(|image| save(&image, &arguments.out)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn parse(arguments: impl Iterator<Item = PathBuf>) -> Option<Arguments> {
    let mut arguments = arguments.peekable();
    let api = arguments.next_if(|one| one == Path::new("--es")).map_or(Api::OpenGl, |_| Api::OpenGlEs);
    let material = match arguments.next_if(|one| one == Path::new("--material")) {
        Some(_) => Some([arguments.next()?, arguments.next()?]),
        None => None,
    };
    let (folder, out) = (arguments.next()?, arguments.next()?);
    arguments.next().is_none().then_some(Arguments { api, material, folder, out })
}

fn draw(arguments: &Arguments) -> Result<Image, Error> {
    let read = |path: &str| text(&arguments.folder.join(path));
    let manifest = read("manifest.json")?;
    let context = Context::open(arguments.api)?;
    let mut host = match &arguments.material {
        None => Host::new(&context, &manifest, &read, SIZE)?,
        Some([vertex, fragment]) => {
            let input =
                |location, name: &str, kind: &str| VertexInput { location, name: name.into(), kind: kind.into() };
            let inputs = vec![input(0, "position", "vec3<f32>"), input(1, "color", "vec4<f32>")];
            let material = Material { vertex: text(vertex)?, fragment: text(fragment)?, inputs };
            Host::with_material(&context, &manifest, &read, SIZE, &material)?
        }
    };
    // Pools that no step sizes hold every pane over every pixel.
    host.set_symbol("fragments", panes::DEEPEST * u64::from(SIZE[0] * SIZE[1]))?;
    let (vertices, objects) = (panes::vertices(host.vertex_inputs(), SIZE), panes::objects());
    let identity = std::array::from_fn(|index| if index % 5 == 0 { 1.0 } else { 0.0 });
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: identity };
    host.render(&scene, [1.0; 4])?.without_losses()
}

fn text(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|error| Error(format!("{}: {error}", path.display())))
}

fn save(image: &Image, out: &Path) -> Result<(), Error> {
    let bytes: Vec<u8> = image
        .pixels
        .iter()
        .flat_map(|[r, g, b, _]| [*r, *g, *b])
        .map(|channel| (channel * 255.0).round() as u8)
        .collect();
    let file = std::fs::File::create(out).map_err(|error| Error(format!("{}: {error}", out.display())))?;
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgb);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes));
    written.map_err(|error| Error(format!("{}: {error}", out.display())))
}
