//! Draws overlapping glass panes with passes that `fragbuf generate` wrote: `fragbuf-opengl-host FOLDER out.png`.

use std::path::PathBuf;
use std::process::ExitCode;

use fragbuf_opengl_host::{Context, Error, Host, Object, Scene, VertexInput};

const SIZE: [u32; 2] = [640, 480];

/// Depth and straight colour of each pane. Each is turned by a sixth of a circle against the one before.
const PANES: [(f32, [f32; 4]); 6] = [
    (0.6, [0.9, 0.2, 0.2, 0.5]),
    (0.3, [0.2, 0.8, 0.3, 0.5]),
    (0.8, [0.2, 0.3, 0.9, 0.5]),
    (0.1, [0.9, 0.8, 0.2, 0.3]),
    (0.9, [0.6, 0.2, 0.8, 0.6]),
    (0.5, [0.2, 0.8, 0.8, 0.4]),
];

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(folder), Some(out), None) = (arguments.next(), arguments.next(), arguments.next()) else {
        eprintln!(
            "usage: fragbuf-opengl-host FOLDER OUT.png\nFOLDER: the output of `fragbuf generate … --target glsl`"
        );
        return ExitCode::from(2);
    };
    match draw(&folder, &out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw(folder: &std::path::Path, out: &std::path::Path) -> Result<(), Error> {
    let read = |path: &str| {
        let path = folder.join(path);
        std::fs::read_to_string(&path).map_err(|error| Error(format!("{}: {error}", path.display())))
    };
    let context = Context::surfaceless()?;
    let mut host = Host::new(&context, &read("manifest.json")?, &read, SIZE)?;
    // Pools that no step sizes: six fragments per pixel at most.
    host.set_symbol("fragments", PANES.len() as u64 * u64::from(SIZE[0] * SIZE[1]));
    let vertices: Vec<u8> =
        (0..).zip(PANES).flat_map(|(index, pane)| pane_vertices(index, pane, host.vertex_inputs())).collect();
    let objects: Vec<Object> = (0..PANES.len() as u32)
        .map(|index| Object { first: 6 * index, count: 6, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] })
        .collect();
    let identity = std::array::from_fn(|index| if index % 5 == 0 { 1.0 } else { 0.0 });
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: identity };
    let image = host.render(&scene, [1.0; 4])?;
    let bytes: Vec<u8> = image.pixels.iter().flatten().map(|channel| (channel * 255.0).round() as u8).collect();
    let file = std::fs::File::create(out).map_err(|error| Error(format!("{}: {error}", out.display())))?;
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Rgba);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes));
    written.map_err(|error| Error(format!("{}: {error}", out.display())))
}

/// Returns two triangles in clip space. Attributes other than position and colour are zero.
fn pane_vertices(index: u32, (depth, color): (f32, [f32; 4]), inputs: &[VertexInput]) -> Vec<u8> {
    let corner = |x: f32, y: f32| {
        let (sin, cos) = (index as f32 * std::f32::consts::FRAC_PI_6).sin_cos();
        let aspect = SIZE[1] as f32 / SIZE[0] as f32;
        [(x * cos - y * sin) * aspect, x * sin + y * cos, depth]
    };
    let (left, right, top, bottom) = (-0.3, 0.9, 0.5, -0.5);
    let corners = [[left, top], [left, bottom], [right, bottom], [left, top], [right, bottom], [right, top]];
    let vertex = |[x, y]: [f32; 2]| {
        inputs.iter().flat_map(move |input| match input.name.as_str() {
            "position" => corner(x, y).to_vec(),
            "color" => color.to_vec(),
            _ => vec![0.0; input.components()],
        })
    };
    corners.into_iter().flat_map(vertex).flat_map(f32::to_le_bytes).collect()
}
