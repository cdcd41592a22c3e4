//! One description, one scene, one frame: drawn again with more room until nothing is lost for want of it.
//!
//! In: a description, a staged scene. Out: premultiplied linear colours and the figures of the frame. What is lost all the
//! same (a lock that was not free in time, more layers than any resolve pass takes) is said on stderr, never hidden.

use fragbuf::{Form, Plan, Registry, Request, TARGETS, Target, Variant, generate, tier};
use fragbuf_runtime::headless::{BLENDED, Headless, Offscreen};
use fragbuf_runtime::wgpu;
use fragbuf_runtime::{Error, Output, Renderer, Settings, Shaders, Sizing, block_on};

use super::attributes::{Geometry, geometry};
use super::input::Input;
use super::output::{Failure, warn};
use super::progress::Progress;
use super::slice::{Slice, SliceFailure};
use super::uniforms;
use super::view::{Stage, View};

/// The choice that counts every event.
const EVERYTHING: (&str, &str) = ("counters", "all");

/// A description as it was asked for.
pub(crate) struct Wish<'a> {
    pub(crate) description: &'a str,
    pub(crate) set: &'a [(String, String)],
    pub(crate) uniforms: &'a [(String, String)],
    /// Whether everything is counted unless the description says otherwise.
    pub(crate) count_all: bool,
}

/// What came of it.
pub(crate) struct Painted {
    pub(crate) slice: Slice,
    pub(crate) info: wgpu::AdapterInfo,
    pub(crate) target: &'static Target,
    pub(crate) plan: Plan,
    /// Frames that were drawn until there was room for everything.
    pub(crate) frames: u32,
}

/// Draws the scene.
pub(crate) fn paint(wish: &Wish<'_>, view: &View, stage: &Stage, progress: &Progress) -> Result<Painted, Failure> {
    let registry = Registry::builtin();
    let mut input = Input::read(wish.description, &registry)?;
    let unless_said: &[(&str, &str)] = if wish.count_all { &[EVERYTHING] } else { &[] };
    let (mut set, mut frames) = (wish.set.to_vec(), 0);
    let (mut said, mut room) = (None, None);
    loop {
        let variant = input.variant_or(&set, unless_said, &registry)?;
        let said = *said.get_or_insert_with(|| says_layers(&variant));
        let painter = Painter::new(&input, &variant, view, &registry)?;
        let painted = painter.paint(wish, view, stage, progress, (&mut frames, &mut room))?;
        match painted.more_layers().filter(|_| !said) {
            Some((option, layers)) => set.push((option, layers.to_string())),
            None => {
                painted.warn(wish.description);
                return Ok(painted);
            }
        }
    }
}

/// A device, and the shaders for it.
struct Painter {
    headless: Headless,
    shaders: Shaders,
    target: &'static Target,
    variant: Variant,
}

impl Painter {
    /// The soundest of the languages that can be run here.
    fn new(input: &Input, variant: &Variant, view: &View, registry: &Registry) -> Result<Self, Failure> {
        let targets: Vec<&'static Target> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(variant, &request, registry).map_err(|faults| input.failure(faults))?;
        let mut candidates: Vec<(&str, &'static Target, Shaders)> = Vec::new();
        for planned in &generation.plans {
            for target in &planned.targets {
                if let Ok(shaders) = Shaders::from_generation(&generation, target.name, 0) {
                    candidates.push((tier(planned.plan.soundness, target), target, shaders));
                }
            }
        }
        candidates.sort_by_key(|(tier, _, _)| *tier);
        let mut refusal = Failure::Input("no language that runs here can express the description".to_owned());
        for (_, target, shaders) in candidates {
            match Headless::open(&view.device, shaders.features()) {
                Ok(headless) => return Ok(Painter { headless, shaders, target, variant: variant.clone() }),
                Err(error @ Error::MissingFeatures(_)) => refusal = error.into(),
                Err(error) => return Err(error.into()),
            }
        }
        Err(refusal)
    }

    /// Draws the whole picture: at once, or in slices as high as the device has memory for.
    fn paint(
        self,
        wish: &Wish<'_>,
        view: &View,
        stage: &Stage,
        progress: &Progress,
        (frames, room): (&mut u32, &mut Option<u32>),
    ) -> Result<Painted, Failure> {
        let (width, height) = view.size;
        let device = &self.headless.device;
        progress.stage(format!("{}: making pipelines", wish.description));
        let mesh = Mesh::upload(device, &self.headless.queue, &geometry(&stage.scene, &self.shaders.plan)?)?;
        let sizing = room.map_or(Sizing::Auto, |fragments| Sizing::Reserve { fragments });
        let settings = Settings { sizing, timestamps: view.json, ..Settings::new(BLENDED, width, height) };
        let mut rows = Renderer::fitting_height(device, &self.shaders, &settings)?;
        let mut whole: Option<Slice> = None;
        let mut top = 0;
        while top < height {
            let sizing = if rows < height { Sizing::Auto } else { sizing };
            let settings = Settings { sizing, height: rows.min(height - top), ..settings.clone() };
            let mut count = || {
                *frames += 1;
                progress.stage(format!("{}: frame {frames}, row {top} of {height}", wish.description));
            };
            match self.slice(wish, &settings, (top, height), stage, &mesh, &mut count) {
                Ok(slice) => {
                    top += settings.height;
                    whole = Some(match whole {
                        Some(above) => above.with(slice),
                        None => slice,
                    });
                }
                // More fragments than a buffer may hold: half as many rows have fewer.
                Err(SliceFailure::TooLarge(_)) if settings.height > 1 => rows = settings.height.div_ceil(2),
                Err(SliceFailure::TooLarge(failure) | SliceFailure::Other(failure)) => return Err(failure),
            }
        }
        let whole = whole.ok_or_else(|| Failure::Device("the picture has no rows".to_owned()))?;
        *room = whole.room;
        Ok(Painted {
            slice: whole,
            info: self.headless.info.clone(),
            target: self.target,
            plan: self.shaders.plan,
            frames: *frames,
        })
    }

    /// Draws one slice until nothing is lost for want of room.
    fn slice(
        &self,
        wish: &Wish<'_>,
        settings: &Settings,
        (top, whole_height): (u32, u32),
        stage: &Stage,
        mesh: &Mesh,
        count: &mut dyn FnMut(),
    ) -> Result<Slice, SliceFailure> {
        let Headless { device, queue, .. } = &self.headless;
        let mut renderer = block_on(device, Renderer::new(device, queue, &self.shaders, settings))??;
        for (name, value) in uniforms::values(wish.uniforms, &self.variant).map_err(SliceFailure::Other)? {
            renderer.set_uniform(&name, value)?;
        }
        renderer.set_camera(&stage.camera.view_projection);
        let offscreen = Offscreen::new(device, BLENDED, settings.width, settings.height)?;
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        let automatic = u64::from(settings.width) * u64::from(settings.height) * u64::from(Sizing::AUTO_PER_PIXEL);
        let mut room = match settings.sizing {
            Sizing::Reserve { fragments } => Some(fragments),
            Sizing::Auto | Sizing::Exact => None,
        };
        loop {
            count();
            renderer.render(&output, &mut |pass, _| {
                pass.set_viewport(0.0, -(top as f32), settings.width as f32, whole_height as f32, 0.0, 1.0);
                mesh.draw(pass);
            })?;
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let counters = renderer.counters(&mut encoder);
            let times = renderer.pass_times(&mut encoder);
            queue.submit([encoder.finish()]);
            let counters = counters.map(|pending| pending.wait(device)).transpose()?;
            let times = times.map(|pending| pending.wait(device)).transpose()?;
            let short = counters.as_ref().map_or(0, |counters| counters.get("pool_exhausted"));
            if short == 0 {
                let pixels = offscreen.colors(device, queue)?;
                return Ok(Slice { pixels, counters, times, bytes: renderer.allocated_bytes(), room });
            }
            // Every fragment that found no room was counted: with so much more there is room for all.
            let needed = room.map_or(automatic, u64::from) + u64::from(short);
            let too_many = || SliceFailure::TooLarge(Failure::Device(format!("{needed} fragments are too many")));
            let fragments = u32::try_from(needed).map_err(|_| too_many())?;
            room = Some(fragments);
            block_on(device, renderer.reserve(fragments))??;
        }
    }
}

/// The parameter of how many layers a resolve pass holds. What exceeds it is counted as `layers_exceeded`.
const LAYERS: &str = "layers";

/// Whether the description, or `--set`, says how many layers a resolve pass holds.
fn says_layers(variant: &Variant) -> bool {
    let mut selected = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    selected.any(|selected| selected.options.iter().any(|(name, _)| name == LAYERS))
}

impl Painted {
    /// The option that makes the resolve pass hold more, and twice what it holds now, where some layers did not fit and
    /// there is more to be had.
    fn more_layers(&self) -> Option<(String, u32)> {
        self.slice.counters.as_ref().filter(|counters| counters.get("layers_exceeded") > 0)?;
        self.plan.selection.rows.iter().find_map(|selected| {
            let parameter = selected.row.parameters.iter().find(|parameter| parameter.name == LAYERS)?;
            let (_, now) = self.plan.constants.iter().find(|(name, _)| *name == parameter.constant)?;
            let more = (2 * now).min(parameter.range.1);
            (more > *now).then(|| (format!("{}.{LAYERS}", selected.row.axis), more))
        })
    }

    /// Whether every event was counted, and not losses alone.
    pub(crate) fn counts_everything(&self) -> bool {
        let (axis, key) = EVERYTHING;
        self.plan.selection.rows.iter().any(|selected| selected.row.axis == axis && selected.row.key == key)
    }

    fn warn(&self, description: &str) {
        for counter in self.slice.counters.iter().flat_map(|counters| &counters.0) {
            // What better fragments displaced is what the description asked for.
            if counter.loss && counter.count > 0 && counter.name != "displaced" {
                warn(&format!("{description}: {} fragments lost: {}", counter.count, counter.name));
            }
        }
    }
}

/// The scene on the device.
struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Mesh {
    fn upload(device: &wgpu::Device, queue: &wgpu::Queue, geometry: &Geometry) -> Result<Self, Failure> {
        let buffer = |label: &str, bytes: &[u8], usage: wgpu::BufferUsages| {
            let (size, limit) = (bytes.len() as u64, device.limits().max_buffer_size);
            if size > limit {
                return Err(Failure::Device(format!(
                    "the scene's {label} need {size} bytes, and the device allows {limit}"
                )));
            }
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            });
            queue.write_buffer(&buffer, 0, bytes);
            Ok(buffer)
        };
        Ok(Mesh {
            vertices: buffer("vertices", &geometry.vertices, wgpu::BufferUsages::VERTEX)?,
            indices: buffer("indices", &geometry.indices, wgpu::BufferUsages::INDEX)?,
            count: geometry.index_count,
        })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}
