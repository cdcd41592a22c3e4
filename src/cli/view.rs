//! The arguments that `render` and `compare` share: the scene, the camera, the device and the output file.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use fragbuf_cpu::FragmentOrder;
use fragbuf_frame::{Conditions, Decisions};
use fragbuf_model::nearest_name;
use fragbuf_scene::{AttributeRequest, BUILTIN_SCENES, Camera, Error, Limits, Scene};

use super::arrangement::{self, Arrangement, Disorder};
use super::assignment::{attribute, texture};
use super::attributes::{self, ModelAttribute};
use super::camera::CameraRequest;
use super::device::{self, DeviceRequest};
use super::memory::{self, Budget};
use super::output::{self, Failure};
use super::picture;
use super::rendered_texture::RenderedTexture;

#[derive(Clone, clap::Args)]
pub(crate) struct View {
    /// Model file (.obj, .ply, .gltf, .glb, .vtk, .vtu, also .gz), or a generated scene: builtin:NAME[,parameter=value]
    #[arg(long, value_name = "PATH|builtin:NAME")]
    pub(crate) scene: String,
    /// Scene to draw first as opaque geometry. Its image is the background; its depth buffer hides fragments behind it. The
    /// camera frames both scenes. The description uses `opaque=in_shader` unless it chooses another value
    #[arg(long, value_name = "PATH|builtin:NAME")]
    opaque: Option<String>,
    /// PNG of the size of the image with the importance of each pixel, white for the most, for `allocation=by_importance`
    #[arg(long, value_name = "PNG")]
    pub(crate) importance: Option<PathBuf>,
    /// Texture of the description: a PNG, with `,slices=N` for three dimensions (slices one below the other), or
    /// `preintegrated:PNG,length=L,extinction=E`, the table of a transfer function for ray segments (or of `builtin:shells`), or
    /// `rendered:DESCRIPTION,camera=CAMERA,size=WxH`, what another description draws of the scene, as floats. Channels are read as stored, from 0 to 1
    #[arg(long = "texture", value_name = "NAME=PNG[,slices=N]", value_parser = texture)]
    pub(crate) textures: Vec<(String, String)>,
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// PNG file to write, or `-` for stdout
    #[arg(long, value_name = "PNG|-", value_parser = picture_path)]
    pub(crate) out: PathBuf,
    /// `auto`: a three-quarter view of the whole scene. `orbit`: the whole scene from a direction in degrees: 0,0 is in front, 90,0 on
    /// the right, 0,90 above. `eye`: from a point of the model to its centre, or to `,target:X,Y,Z`. Both take the vertical field of
    /// view as `,fov:DEGREES`, 40 by default, and a magnification as `,zoom:FACTOR`. `clip`: positions are clip-space positions
    #[arg(long, default_value = "auto", value_name = "auto|clip|orbit:AZIMUTH,ELEVATION|eye:X,Y,Z")]
    pub(crate) camera: CameraRequest,
    /// Light the scene from the camera position, or use its colours unlit
    #[arg(long, value_enum, default_value_t = Shading::Lit)]
    shading: Shading,
    /// Background colour: linear, straight alpha
    #[arg(long, value_name = "r,g,b,a", default_value = "1,1,1,1", value_parser = color)]
    pub(crate) background: [f32; 4],
    /// Colour of parts for which the model gives none: linear, straight alpha
    #[arg(long, value_name = "r,g,b,a", default_value = "0.15,0.45,0.35,0.4", value_parser = color)]
    color: [f32; 4],
    /// Set an attribute of fragments to a value for every vertex, instead of the scene's data
    #[arg(long = "attribute", value_name = "NAME=VALUE[,VALUE]", value_parser = attribute)]
    pub(crate) attributes: Vec<(String, String)>,
    /// Write linear values to the PNG instead of sRGB
    #[arg(long)]
    pub(crate) linear: bool,
    /// `auto`: a GPU if there is one, else the CPU device, or a software driver for frames of many fragments. `cpu`: the CPU device,
    /// which needs no driver. NAME: an adapter whose name contains NAME
    #[arg(long, default_value = "auto", value_name = "auto|cpu|NAME")]
    pub(crate) device: DeviceRequest,
    /// Order of same-pixel fragments on the CPU device: as submitted; with their shaders permuted and interleaved by a seed; or
    /// interleaved, but begun as submitted, so that only those of some consecutive triangles overlap. Fixed-function tests and blending
    /// keep the order of submission
    #[arg(long, value_name = "submission|shuffle:SEED|window:SEED,TRIANGLES", value_parser = device::order)]
    pub(crate) order: Option<FragmentOrder>,
    /// Who ends a loop of peeling: the host, which waits for the device after every iteration, or the device, in a frame with all iterations
    /// that the description allows, of which those after the end draw nothing
    #[arg(long, value_enum, default_value_t = Loops::Host)]
    pub(crate) loops: Loops,
    #[command(flatten)]
    pub(crate) arrangement: Arrangement,
    /// Memory budget for scenes, images and frames: bytes, or a number of KiB, MiB, GiB or TiB. A frame that needs more is drawn in
    /// slices of rows
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = memory::budget)]
    memory: Budget,
    /// Reject a model if a part of it is missing, malformed or not read. Without it, a warning reports what replaces the part
    #[arg(long)]
    strict: bool,
    /// Read no files that a model names: material libraries and buffers. For models of unknown origin
    #[arg(long)]
    pub(crate) no_references: bool,
    /// Print statistics as JSON on stdout. Uses `counters=all` unless the description chooses another value
    #[arg(long)]
    pub(crate) json: bool,
    /// Whether an earlier frame has printed the warnings about the models.
    #[arg(skip)]
    pub(crate) is_later_frame: bool,
    /// Whether frames use the decisions of their own host steps, or those of earlier frames.
    #[arg(skip)]
    pub(crate) decisions: Decisions,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Shading {
    Lit,
    #[value(alias = "flat")]
    Unlit,
}

/// Who ends loops.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Loops {
    Host,
    Device,
}

impl Loops {
    pub(crate) fn conditions(self) -> Conditions {
        match self {
            Loops::Host => Conditions::OnHost,
            Loops::Device => Conditions::OnDevice,
        }
    }
}

/// A scene with its final colours, and the camera that views it.
pub(crate) struct SceneView {
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
    /// Whether colours are unlit, so that the image must equal exact arithmetic over the scene's own colours.
    pub(crate) is_unlit: bool,
    /// The triangles of a draw; `None`: all.
    pub(crate) batch: Option<NonZeroU32>,
    /// The disorder of its fragments, if the arrangement of triangles is not that of the model and their memory suffices.
    pub(crate) disorder: Option<Disorder>,
    /// The cameras of textures that other descriptions draw, by the names of the textures.
    pub(crate) texture_cameras: Vec<(String, Camera)>,
}

impl SceneView {
    /// Returns the view of a scene as it is modelled.
    pub(crate) fn new(scene: Scene, camera: Camera) -> Self {
        SceneView { scene, camera, is_unlit: true, batch: None, disorder: None, texture_cameras: Vec::new() }
    }
}

impl View {
    /// Returns the view of a measurement: it has a scene, a camera, a size and a device, writes no image, and measures the times of passes.
    pub(crate) fn measured(
        scene: String,
        camera: CameraRequest,
        size: (u32, u32),
        (device, order): (DeviceRequest, Option<FragmentOrder>),
        memory: Budget,
    ) -> Self {
        View {
            scene,
            opaque: None,
            importance: None,
            textures: Vec::new(),
            size,
            out: PathBuf::new(),
            camera,
            shading: Shading::Lit,
            background: [1.0; 4],
            color: [1.0; 4],
            attributes: Vec::new(),
            linear: false,
            device,
            order,
            loops: Loops::Host,
            arrangement: Arrangement::default(),
            memory,
            strict: false,
            no_references: false,
            json: true,
            is_later_frame: false,
            decisions: Decisions::Immediate,
        }
    }

    /// Loads or generates the scene with these attributes, and the opaque scene, whose alpha becomes 1. The camera frames both.
    pub(crate) fn scene_views(&self, attributes: &[ModelAttribute]) -> Result<(SceneView, Option<SceneView>), Failure> {
        let mut scene = self.open(&self.scene, attributes, self.memory)?;
        let Some(opaque) = &self.opaque else {
            let camera = self.camera(&[&scene])?;
            let cameras = self.texture_cameras(&[&scene])?;
            let scene = SceneView { texture_cameras: cameras, ..self.scene_view(scene, camera) };
            return Ok((self.arranged(scene, self.memory)?, None));
        };
        let rest = self.memory.without(scene.bytes(), "the scene")?;
        let mut opaque = self.open(opaque, &[], rest)?;
        scene.share_placement(&mut opaque);
        let colors = opaque.objects.iter_mut().flat_map(|object| &mut object.colors);
        colors.for_each(|[_, _, _, alpha]| *alpha = 1.0);
        let camera = self.camera(&[&scene, &opaque])?;
        let texture_cameras = self.texture_cameras(&[&scene, &opaque])?;
        let opaque = self.scene_view(opaque, camera);
        let rest = self.memory.without(opaque.scene.bytes(), "the opaque scene")?;
        let scene = SceneView { texture_cameras, ..self.scene_view(scene, camera) };
        Ok((self.arranged(scene, rest)?, Some(opaque)))
    }

    /// Places the cameras of textures that other descriptions draw.
    fn texture_cameras(&self, scenes: &[&Scene]) -> Result<Vec<(String, Camera)>, Failure> {
        let place = |texture: RenderedTexture| {
            let camera = texture.camera.place(scenes, texture.size.0 as f32 / texture.size.1 as f32);
            let camera = camera.map_err(|error| Failure::Usage(format!("`--texture {}`: {error}", texture.name)))?;
            Ok((texture.name, camera))
        };
        RenderedTexture::all(self)?.into_iter().map(place).collect()
    }

    /// Arranges the triangles of a scene, and prints the disorder of its fragments.
    fn arranged(&self, mut view: SceneView, memory: Budget) -> Result<SceneView, Failure> {
        self.arrangement.apply(&mut view, self.size, memory)?;
        if !self.json && !self.is_later_frame {
            arrangement::print(&view);
        }
        Ok(view)
    }

    /// Loads or generates a scene within the rest of a budget, and prints its warnings. An error has the whole budget as its limit.
    fn open(&self, name: &str, attributes: &[ModelAttribute], memory: Budget) -> Result<Scene, Failure> {
        if name.trim().is_empty() {
            let help = "give a model file, or a generated scene such as `builtin:cubes`";
            return Err(Failure::Usage(format!("the name of a scene is empty: {help}")));
        }
        let requests: Vec<AttributeRequest> = attributes.iter().map(|attribute| attribute.request.clone()).collect();
        let limits = Limits { memory: memory.left(), reads_named_files: !self.no_references };
        let opened = fragbuf_scene::open_with(name, self.color, &requests, &limits);
        let mut scene = opened.map_err(|error| match error {
            Error::TooLarge { file, what, needed, left, .. } => {
                Error::TooLarge { file, what, needed, left, limit: memory.whole() }.into()
            }
            Error::MissingAttribute { scene, request, available, other } => {
                attributes::missing((&scene, other.as_deref()), &request, &available, attributes)
            }
            other => Failure::from(other),
        })?;
        if self.strict && !scene.warnings.is_empty() {
            return Err(Failure::Model(scene.warnings));
        }
        for warning in scene.warnings.iter().filter(|_| !self.is_later_frame) {
            output::warn_code(warning.kind.code(), &warning.to_string());
        }
        if self.camera == CameraRequest::Clip {
            scene.use_model_coordinates();
        }
        Ok(scene)
    }

    /// Returns the paths of the models among the scenes, and those of images.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let scenes = std::iter::once(&self.scene).chain(&self.opaque);
        let models = scenes.filter(|scene| !scene.starts_with("builtin:")).map(PathBuf::from);
        let textures = self.textures.iter().filter_map(|(_, source)| match source.strip_prefix("preintegrated:") {
            None if source.starts_with("rendered:") => RenderedTexture::file(source).map(PathBuf::from),
            Some(table) if table.starts_with("builtin:") => None,
            path => path.unwrap_or(source).split(',').next().map(PathBuf::from),
        });
        models.chain(self.importance.clone()).chain(textures)
    }

    /// Returns the memory that is left beside scenes.
    pub(crate) fn memory_beside(&self, scenes: &[&SceneView]) -> Result<Budget, Failure> {
        let bytes = scenes.iter().fold(0, |sum: u64, view| sum.saturating_add(view.scene.bytes()));
        self.memory.without(bytes, "the scene")
    }

    /// Returns the bytes of `bytes` bytes per pixel of the image.
    pub(crate) fn image_bytes(&self, bytes: u64) -> u64 {
        (u64::from(self.size.0) * u64::from(self.size.1)).saturating_mul(bytes)
    }

    fn camera(&self, scenes: &[&Scene]) -> Result<Camera, Failure> {
        let camera = self.camera.place(scenes, self.size.0 as f32 / self.size.1 as f32);
        camera.map_err(|error| Failure::Usage(format!("`--camera`: {error}")))
    }

    fn scene_view(&self, mut scene: Scene, camera: Camera) -> SceneView {
        let is_unlit = matches!(self.shading, Shading::Unlit);
        if !is_unlit {
            fragbuf_scene::light(&mut scene, camera.eye);
        }
        SceneView { is_unlit, ..SceneView::new(scene, camera) }
    }

    /// Checks the names of generated scenes and the output, before any scene is loaded.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if picture::is_stdout(&self.out) && self.json {
            return Err(Failure::Usage(
                "`--out -` and `--json` both write to stdout: give a file for one of them".to_owned(),
            ));
        }
        check_picture(&self.out)?;
        std::iter::once(&self.scene).chain(&self.opaque).try_for_each(|scene| check(scene))
    }
}

/// Checks that an image can be written to a path, before it is rendered.
pub(crate) fn check_picture(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder.filter(|folder| !folder.is_dir()) {
        Some(folder) => {
            Err(Failure::Files(format!("{}: its folder {} does not exist", path.display(), folder.display())))
        }
        None if path.is_dir() => Err(Failure::Files(format!("{} is a folder: give a file", path.display()))),
        None => Ok(()),
    }
}

/// Checks the name of a scene.
pub(crate) fn check(scene: &str) -> Result<(), Failure> {
    let names: Vec<&str> = BUILTIN_SCENES.iter().map(|row| row.name).collect();
    // Parameters follow the name.
    let first = |text: &str| text.split(',').next().unwrap_or_default().to_owned();
    let Some(name) = scene.strip_prefix("builtin:") else {
        let nearest = nearest_name(&first(scene), &names).filter(|_| !Path::new(scene).exists());
        return match nearest {
            Some(nearest) => {
                Err(Failure::Usage(format!("no file `{scene}`: did you mean the scene `builtin:{nearest}`?")))
            }
            None => Ok(()),
        };
    };
    match (name.parse::<fragbuf_scene::BuiltinScene>(), nearest_name(&first(name), &names)) {
        (Err(error), Some(nearest)) if !names.contains(&first(name).as_str()) => {
            Err(Failure::Usage(format!("{error}; did you mean `builtin:{nearest}`?")))
        }
        (parsed, _) => Ok(parsed.map(|_| ())?),
    }
}

/// Parses the path of a PNG.
pub(crate) fn picture_path(text: &str) -> Result<PathBuf, String> {
    if text.is_empty() {
        return Err("the path is empty: give a file, such as image.png".to_owned());
    }
    let path = PathBuf::from(text);
    let is_png = |extension: &std::ffi::OsStr| extension.eq_ignore_ascii_case("png");
    match path.extension() {
        Some(extension) if !is_png(extension) => Err(format!(
            "images are written as PNG: write `{}`, or `-` for stdout",
            path.with_extension("png").display()
        )),
        _ => Ok(path),
    }
}

/// Returns the list of generated scenes that the help shows, each with its parameters and the attributes of its vertices.
pub(crate) fn scenes() -> String {
    let mut text = "Generated scenes:\n".to_owned();
    for row in BUILTIN_SCENES {
        let parameters: Vec<String> =
            row.parameters.iter().map(|parameter| format!("{}={}", parameter.name, parameter.default)).collect();
        let attribute = |attribute: &fragbuf_scene::Attribute| match (attribute.is_integer, attribute.components) {
            (true, _) => format!("{}: u32", attribute.name),
            (false, 1) => format!("{}: f32", attribute.name),
            (false, components) => format!("{}: vec{components}", attribute.name),
        };
        let attributes: Vec<String> = row.attributes.iter().map(attribute).collect();
        let attributes = if attributes.is_empty() { String::new() } else { format!("  {{{}}}", attributes.join(", ")) };
        text.push_str(&format!("  builtin:{:10}{}  [{}]{attributes}\n", row.name, row.summary, parameters.join(", ")));
    }
    text
}

/// Parses `WIDTHxHEIGHT`.
pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    const FORM: &str = "write WIDTHxHEIGHT in pixels, as 640x480";
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or(FORM)?;
    let side = |text: &str| match text.trim().parse::<u64>() {
        Ok(0) => Err(format!("a side has 1 pixel or more: {FORM}")),
        Ok(pixels) => u32::try_from(pixels).map_err(|_| format!("a side has at most {} pixels: {FORM}", u32::MAX)),
        Err(_) => Err(FORM.to_owned()),
    };
    Ok((side(width)?, side(height)?))
}

/// Parses `red,green,blue,alpha`.
fn color(text: &str) -> Result<[f32; 4], String> {
    let values: Option<Vec<f32>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let values = values.and_then(|values| <[f32; 4]>::try_from(values).ok());
    values
        .filter(|values| values.iter().all(|value| (0.0..=1.0).contains(value)))
        .ok_or_else(|| "write red,green,blue,alpha, each from 0 to 1".to_owned())
}
