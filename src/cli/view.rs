//! What is seen, from where, and where the picture goes: the arguments that `render` and `compare` share.

use std::path::PathBuf;

use fragbuf_cpu::Order;
use fragbuf_scene::{BUILTIN, Camera, Scene};

use super::device::{self, Picked, Wanted};
use super::output::Failure;

#[derive(clap::Args)]
pub(crate) struct View {
    /// A model (.obj, .ply, .gltf, .glb, also .gz), or a generated scene: builtin:NAME[,parameter=value]
    #[arg(long, value_name = "PATH|builtin:NAME")]
    pub(crate) scene: String,
    /// A scene that is drawn first, as if opaque: what lies behind it is turned away, its picture is behind the other. The camera
    /// frames both. A description takes opaque=in_shader unless it says otherwise
    #[arg(long, value_name = "PATH|builtin:NAME")]
    opaque: Option<String>,
    /// Pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// The PNG to write
    #[arg(long, value_name = "PNG")]
    pub(crate) out: PathBuf,
    /// Three-quarter view of the whole scene, or positions as clip-space positions
    #[arg(long, value_enum, default_value_t = CameraArgument::Auto)]
    camera: CameraArgument,
    /// Lit by a lamp at the eye, or the bare colours
    #[arg(long, value_enum, default_value_t = Shading::Lit)]
    shading: Shading,
    /// What is behind everything: linear, straight alpha
    #[arg(long, value_name = "r,g,b,a", default_value = "1,1,1,1", value_parser = color)]
    pub(crate) background: [f32; 4],
    /// Colour of what the model gives none: linear, straight alpha
    #[arg(long, value_name = "r,g,b,a", default_value = "0.15,0.45,0.35,0.4", value_parser = color)]
    color: [f32; 4],
    /// Linear values in the PNG, and not sRGB
    #[arg(long)]
    pub(crate) linear: bool,
    /// A GPU where there is one, else the CPU device; the CPU device, which needs no driver; or an adapter by a part of its name
    #[arg(long, default_value = "auto", value_name = "auto|cpu|NAME")]
    device: Wanted,
    /// The order of same-pixel fragments on the CPU device: as submitted, or their shaders interleaved by a seed; tests and
    /// blending keep the order of submission
    #[arg(long, value_name = "submission|shuffle:SEED", value_parser = device::order)]
    order: Option<Order>,
    /// Figures on stdout, as JSON; counts every event unless the description says otherwise
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum CameraArgument {
    Auto,
    Clip,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Shading {
    Lit,
    Flat,
}

/// A scene as it is drawn: lit, where it shall be, and seen.
pub(crate) struct Stage {
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
    /// Whether the picture shall be what arithmetic over the scene's own colours says.
    pub(crate) exact: bool,
}

impl View {
    /// Loads or makes the scene, and the one that is opaque, whatever its alpha; the camera frames both.
    pub(crate) fn stages(&self) -> Result<(Stage, Option<Stage>), Failure> {
        let scene = fragbuf_scene::open(&self.scene, self.color)?;
        let Some(opaque) = &self.opaque else {
            let camera = self.camera(&scene);
            return Ok((self.staged(scene, camera), None));
        };
        let mut opaque = fragbuf_scene::open(opaque, self.color)?;
        let colors = opaque.objects.iter_mut().flat_map(|object| &mut object.colors);
        colors.for_each(|[_, _, _, alpha]| *alpha = 1.0);
        let both = Scene { objects: scene.objects.iter().chain(&opaque.objects).cloned().collect() };
        let camera = self.camera(&both);
        Ok((self.staged(scene, camera), Some(self.staged(opaque, camera))))
    }

    fn camera(&self, scene: &Scene) -> Camera {
        match self.camera {
            CameraArgument::Auto => Camera::framing(scene, self.size.0 as f32 / self.size.1 as f32),
            CameraArgument::Clip => Camera::clip(),
        }
    }

    fn staged(&self, mut scene: Scene, camera: Camera) -> Stage {
        let exact = match self.shading {
            Shading::Flat => true,
            Shading::Lit => {
                fragbuf_scene::light(&mut scene, camera.eye);
                false
            }
        };
        Stage { scene, camera, exact }
    }

    /// What will draw.
    pub(crate) fn picked(&self) -> Result<Picked, Failure> {
        self.device.pick(self.order)
    }

    /// What is wrong with the arguments and needs no work to see.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        std::iter::once(&self.scene).chain(&self.opaque).try_for_each(|scene| check(scene))
    }
}

/// What is wrong with the name of a scene and needs no work to see.
fn check(scene: &str) -> Result<(), Failure> {
    if let Some(name) = scene.strip_prefix("builtin:") {
        name.parse::<fragbuf_scene::Builtin>()?;
    }
    Ok(())
}

/// The generated scenes, for the help.
pub(crate) fn scenes() -> String {
    let mut text = "Generated scenes:\n".to_owned();
    for row in BUILTIN {
        let parameters: Vec<String> =
            row.parameters.iter().map(|parameter| format!("{}={}", parameter.name, parameter.default)).collect();
        text.push_str(&format!("  builtin:{:10}{}  [{}]\n", row.name, row.summary, parameters.join(", ")));
    }
    text
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides
        .filter(|(width, height)| *width > 0 && *height > 0)
        .ok_or_else(|| "write WIDTHxHEIGHT in pixels, as 640x480".to_owned())
}

fn color(text: &str) -> Result<[f32; 4], String> {
    let values: Option<Vec<f32>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let values = values.and_then(|values| <[f32; 4]>::try_from(values).ok());
    values
        .filter(|values| values.iter().all(|value| (0.0..=1.0).contains(value)))
        .ok_or_else(|| "write red,green,blue,alpha, each from 0 to 1".to_owned())
}
