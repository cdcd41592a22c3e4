//! One description, one scene, one frame: drawn again with more room until nothing is lost for want of it.
//!
//! In: a description, a staged scene. Out: premultiplied linear colours and the figures of the frame. What is lost all the
//! same (a lock that was not free in time, more layers than any resolve pass takes) is said on stderr, never hidden.

use fragbuf::{Form, Plan, Registry, Request, TARGETS, Target, Variant, generate, tier};
use fragbuf_runtime::headless::{BLENDED, Headless, Offscreen};
use fragbuf_runtime::wgpu;
use fragbuf_runtime::{
    Counters, Error, Output, PassTime, Pipelines, Renderer, Room, Settings, Shaders, Sizing, block_on,
};
use fragbuf_scene::Scene;

use super::attributes::{Geometry, geometry};
use super::input::Input;
use super::output::{Failure, warn};
use super::progress::Progress;
use super::uniforms;
use super::view::{Stage, View};

/// The payload that does not round what a scene's colours are. The papers' rounds each layer to 255ths.
const UNROUNDED: (&str, &str) = ("fragment.color", "rgba16");

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
    pub(crate) drawn: Figures,
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
    let rounded = stage.exact && !in_255ths(&stage.scene);
    let mut unless_said: Vec<(&str, &str)> = [(wish.count_all, EVERYTHING), (rounded, UNROUNDED)]
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, set)| set)
        .collect();
    // A storage whose slots hold no more than the papers' payload rounds as the papers do.
    if rounded && input.variant_or(wish.set, &unless_said, &registry).is_err() {
        unless_said.retain(|set| *set != UNROUNDED);
    }
    let (mut set, mut frames) = (wish.set.to_vec(), 0);
    let (mut said, mut room) = (None, None);
    loop {
        let variant = input.variant_or(&set, &unless_said, &registry)?;
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

/// Whether 8 bits a channel hold every colour of the scene, but for the rounding of its text.
fn in_255ths(scene: &Scene) -> bool {
    let whole = |channel: &f32| (255.0 * channel - (255.0 * channel).round()).abs() < 1.0e-3;
    scene.objects.iter().all(|object| object.colors.iter().flatten().all(whole))
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
            if let Err(error) = shaders.check() {
                refusal = error.into();
                continue;
            }
            match Headless::open(&view.device, shaders.features()) {
                Ok(headless) => return Ok(Painter { headless, shaders, target, variant: variant.clone() }),
                Err(error @ Error::MissingFeatures(_)) => refusal = error.into(),
                Err(error) => return Err(error.into()),
            }
        }
        Err(refusal)
    }

    /// Draws the picture until nothing is lost for want of room, in slices as high as the device has memory for.
    fn paint(
        self,
        wish: &Wish<'_>,
        view: &View,
        stage: &Stage,
        progress: &Progress,
        (frames, room): (&mut u32, &mut Option<u32>),
    ) -> Result<Painted, Failure> {
        let (width, height) = view.size;
        let Headless { device, queue, .. } = &self.headless;
        progress.stage(format!("{}: making pipelines", wish.description));
        let mesh = Mesh::upload(device, queue, &geometry(&stage.scene, &self.shaders.plan)?)?;
        let settings = Settings { timestamps: view.json, ..Settings::new(BLENDED, width, height) };
        let pipelines = block_on(device, Pipelines::new(device, &self.shaders, &settings))??;
        let uniforms = uniforms::values(wish.uniforms, &self.variant)?;
        let (mut slice, mut rows) = (None, height);
        let drawn = loop {
            let sizing = room.map_or(Sizing::Auto, |fragments| Sizing::Reserve(Room::Fragments(fragments)));
            let settings = Settings { sizing, slice, ..settings.clone() };
            let mut renderer = match block_on(device, Renderer::with(device, queue, &pipelines, &settings))? {
                // Room for all fragments of so many rows is too much.
                Err(Error::TooLarge { .. } | Error::OutOfMemory { .. }) if room.is_some() && rows > 1 => {
                    rows = rows.div_ceil(2);
                    (slice, *room) = (Some(rows), None);
                    continue;
                }
                made => made?,
            };
            for (name, value) in &uniforms {
                renderer.set_uniform(name, *value)?;
            }
            *frames += 1;
            progress.stage(format!("{}: frame {frames}, slices: {}", wish.description, renderer.slices()));
            rows = height.div_ceil(renderer.slices());
            match self.frame(&mut renderer, stage, &mesh, view.size) {
                Ok(Drawn::Short(more)) => *room = Some(more),
                Ok(Drawn::Whole(drawn)) => break drawn,
                // More fragments than a buffer may hold: half as many rows have fewer.
                Err(Error::TooLarge { .. } | Error::OutOfMemory { .. }) if rows > 1 => {
                    rows = rows.div_ceil(2);
                    (slice, *room) = (Some(rows), None);
                }
                Err(error) => return Err(error.into()),
            }
        };
        Ok(Painted {
            drawn,
            info: self.headless.info.clone(),
            target: self.target,
            plan: self.shaders.plan,
            frames: *frames,
        })
    }

    /// Draws one frame.
    fn frame(
        &self,
        renderer: &mut Renderer,
        stage: &Stage,
        mesh: &Mesh,
        (width, height): (u32, u32),
    ) -> Result<Drawn, Error> {
        let Headless { device, queue, .. } = &self.headless;
        renderer.set_camera(&stage.camera.view_projection);
        let offscreen = Offscreen::new(device, BLENDED, width, height)?;
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        renderer.render(&output, &mut |pass, _| mesh.draw(pass))?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (counters, each) = (renderer.counters(&mut encoder), renderer.slice_counters(&mut encoder));
        let times = renderer.pass_times(&mut encoder);
        queue.submit([encoder.finish()]);
        let counters = counters.map(|pending| pending.wait(device)).transpose()?;
        let each = each.map(|pending| pending.wait(device)).transpose()?;
        let times = times.map(|pending| pending.wait(device)).transpose()?;
        let short = each.iter().flatten().map(|slice| slice.get(EXHAUSTED)).max().unwrap_or(0);
        if short > 0 {
            // Every fragment that found no room was counted.
            let needed = renderer.room_after(short);
            let fragments = u32::try_from(needed).map_err(|_| Error::TooLarge {
                what: "the room for the picture's fragments".to_owned(),
                needed,
                limit: u32::MAX.into(),
                limit_name: "fragments",
                hint: "draw lower slices",
            })?;
            return Ok(Drawn::Short(fragments));
        }
        let pixels = offscreen.colors(device, queue)?;
        Ok(Drawn::Whole(Figures {
            pixels,
            counters,
            times,
            bytes: renderer.allocated_bytes(),
            slices: renderer.slices(),
        }))
    }
}

/// The counter of fragments that found no room.
const EXHAUSTED: &str = "pool_exhausted";

/// What one frame came to.
enum Drawn {
    /// Room for so many fragments is needed.
    Short(u32),
    Whole(Figures),
}

/// A picture and its figures.
pub(crate) struct Figures {
    /// Premultiplied linear colours.
    pub(crate) pixels: Vec<[f32; 4]>,
    pub(crate) counters: Option<Counters>,
    pub(crate) times: Option<Vec<PassTime>>,
    /// Bytes held at one time.
    pub(crate) bytes: u64,
    pub(crate) slices: u32,
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
        self.drawn.counters.as_ref().filter(|counters| counters.get("layers_exceeded") > 0)?;
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
        if self.drawn.pixels.iter().all(|[_, _, _, alpha]| *alpha == 0.0) {
            warn(&format!(
                "{description}: no fragment is seen; look at the camera, at `where`, and at uniforms, which are 0 unless given"
            ));
        }
        for counter in self.drawn.counters.iter().flat_map(|counters| &counters.0) {
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
