//! Renders a task on an adapter of wgpu's: a GPU or a software driver.
//!
//! Input: a task and the selected adapter. Output: the result, redrawn with a larger pool until no fragment is lost to
//! overflow, in slices as high as the device's limits and the memory budget allow.

use fragbuf::vocabulary::Objects;
use fragbuf::{Diagnostics, Form, Registry, Request, TARGETS, Target, Variant, generate, tier};
use fragbuf_frame::{POOL_EXHAUSTED, PoolSize, Sizing};
use fragbuf_runtime::headless::{BLENDED, Headless, Offscreen, supported_interlock};
use fragbuf_runtime::wgpu;
use fragbuf_runtime::{Error, Output, Pipelines, Renderer, Settings, Shaders, block_on};

use super::external::ExternalTextures;
use super::importance::Importance;
use super::mesh::Mesh;
use super::opaque::{OpaqueScene, depth_texture};
use super::prepared::FrameTime;
use super::request::{RedrawState, RenderTask};
use super::result::{FrameStats, RenderResult};
use super::textures;
use crate::cli::attributes::geometry;
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::uniforms;
use crate::cli::view::SceneView;

/// Renders the task. Returns the frame, too, which can be drawn again.
pub(super) fn render(
    task: &RenderTask<'_>,
    adapter: &wgpu::Adapter,
    (input, registry): (&Input, &Registry),
    redraw: &mut RedrawState,
) -> Result<(RenderResult, GpuFrame), Failure> {
    let renderer = GpuRenderer::new(task, adapter, input, registry)?;
    let opaque = task.opaque.map(|opaque| renderer.render_opaque(task, opaque, registry)).transpose()?;
    renderer.render(task, opaque, redraw)
}

/// Returns why the adapter cannot run the variant, as far as its features show it. An invalid variant is an error of the rendering.
pub(super) fn missing(adapter: &wgpu::Adapter, variant: &Variant, registry: &Registry) -> Option<String> {
    let candidates = candidates(variant, registry).ok()?;
    runnable(candidates, adapter).err().map(|error| match error {
        Error::MissingFeatures(features) => format!("it lacks {features:?}"),
        Error::Unsupported { what, .. } => format!("it does not support {what}"),
        other => other.to_string(),
    })
}

/// Returns the shaders of every target that the runtime can run, the best soundness tier first.
fn candidates(variant: &Variant, registry: &Registry) -> Result<Vec<(&'static Target, Shaders)>, Diagnostics> {
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(variant, &request, registry)?;
    let mut candidates: Vec<(&str, &'static Target, Shaders)> = Vec::new();
    for planned in &generation.plans {
        for target in &planned.targets {
            if let Ok(shaders) = Shaders::from_generation(&generation, target.name, 0) {
                candidates.push((tier(planned.plan.soundness, target), target, shaders));
            }
        }
    }
    candidates.sort_by_key(|(tier, _, _)| *tier);
    Ok(candidates.into_iter().map(|(_, target, shaders)| (target, shaders)).collect())
}

/// Returns the first shaders that the adapter can run.
fn runnable(
    candidates: Vec<(&'static Target, Shaders)>,
    adapter: &wgpu::Adapter,
) -> Result<(&'static Target, Shaders), Error> {
    let mut failure = Error::Unsupported {
        what: "any target of the description".to_owned(),
        help: "choose other values on its axes".to_owned(),
    };
    for (target, shaders) in candidates {
        let missing = shaders.features() - adapter.features();
        let checked = match missing.is_empty() {
            true => shaders.check().and_then(|()| check_interlock(&shaders, adapter)),
            false => Err(Error::MissingFeatures(missing)),
        };
        match checked {
            Ok(()) => return Ok((target, shaders)),
            Err(error) => failure = error,
        }
    }
    Err(failure)
}

/// Checks whether the driver of an adapter has the interlock of the shaders.
fn check_interlock(shaders: &Shaders, adapter: &wgpu::Adapter) -> Result<(), Error> {
    shaders.check_interlock(supported_interlock(adapter)).map_err(|_| Error::Unsupported {
        what: "fragment shader interlock, because the driver has no `VK_EXT_fragment_shader_interlock`".to_owned(),
        help: "write `sync: interlock else spin_lock`, or choose another device".to_owned(),
    })
}

/// A frame that can be drawn again: a renderer with the capacity for its fragments, and the geometry of its scene.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
pub(crate) struct GpuFrame {
    gpu: GpuRenderer,
    renderer: Renderer,
    mesh: Mesh,
    size: (u32, u32),
    /// The image; `None` until the frame is drawn again.
    offscreen: Option<Offscreen>,
}

#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
impl GpuFrame {
    /// Draws the frame again, and reads back its times alone.
    pub(super) fn draw(&mut self) -> Result<FrameTime, Failure> {
        let GpuFrame { gpu, renderer, mesh, size, offscreen } = self;
        let Headless { device, queue, .. } = &gpu.headless;
        let offscreen = match offscreen {
            Some(offscreen) => offscreen,
            none => none.insert(Offscreen::new(device, BLENDED, size.0, size.1)?),
        };
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        FrameTime::measure(|| {
            renderer.render(&output, &mut |pass, call| mesh.draw(pass, call))?;
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let times = renderer.pass_times(&mut encoder);
            queue.submit([encoder.finish()]);
            Ok(times.map(|pending| pending.wait(device)).transpose()?.unwrap_or_default())
        })
    }
}

/// A device, and the shaders for it.
struct GpuRenderer {
    headless: Headless,
    shaders: Shaders,
    target: &'static Target,
}

impl GpuRenderer {
    /// Opens a device with the shaders of the target that has the best soundness tier among those that run on it.
    fn new(
        task: &RenderTask<'_>,
        adapter: &wgpu::Adapter,
        input: &Input,
        registry: &Registry,
    ) -> Result<Self, Failure> {
        let candidates = candidates(task.variant, registry).map_err(|errors| input.failure(errors))?;
        let (target, shaders) = runnable(candidates, adapter)?;
        let headless = Headless::open_adapter(adapter, shaders.features())?;
        Ok(GpuRenderer { headless, shaders, target })
    }

    /// Draws frames until no fragment is lost to overflow, in slices as high as the device's memory allows.
    fn render(
        self,
        task: &RenderTask<'_>,
        opaque: Option<OpaqueImage>,
        redraw: &mut RedrawState,
    ) -> Result<(RenderResult, GpuFrame), Failure> {
        let RenderTask { request, view, scene, progress, variant, opaque: opaque_scene, memory } = task;
        let external = ExternalTextures::of(&self.shaders.plan, view, *opaque_scene)?;
        let (width, height) = view.size;
        let Headless { device, queue, .. } = &self.headless;
        progress.set_message(format!("{}: creating pipelines", request.description));
        let geometry = geometry((&scene.scene, &view.attributes), &self.shaders.plan, *memory)?;
        let mesh = Mesh::upload(device, queue, &geometry, scene.batch)?;
        let opaque_bytes = if opaque.is_some() { view.image_bytes(OPAQUE_IMAGE) } else { 0 };
        let memory = geometry.memory.without(opaque_bytes, "the image of the opaque scene")?;
        let memory = memory.without(view.image_bytes(IMAGE), "the image")?;
        let importance = view.importance.as_ref().filter(|_| !external.importance.is_empty());
        let importance = importance.map(|path| Importance::read(path, view.size, memory)).transpose()?;
        let memory = importance.as_ref().map_or(memory, |importance| importance.memory);
        let importance = importance.map(|importance| importance.upload(device, queue, view.size));
        let (textures, memory) = textures::read(variant, &view.textures, memory)?;
        let textures = textures::upload(variant, &textures, device, queue)?;
        let memory = memory.left();
        drop(geometry);
        let settings = Settings {
            memory,
            decisions: view.decisions,
            conditions: view.loops.conditions(),
            timestamps: view.json,
            interlock: self.headless.interlock,
            ..Settings::new(BLENDED, width, height)
        };
        let pipelines = block_on(device, Pipelines::new(device, &self.shaders, &settings))??;
        let uniforms = uniforms::values(request.uniforms, variant, scene)?;
        let (stats, renderer) = loop {
            let sizing =
                redraw.pool_size.map_or(Sizing::Auto, |fragments| Sizing::Capacity(PoolSize::Fragments(fragments)));
            let settings = Settings { sizing, slice: redraw.slice, ..settings.clone() };
            let mut renderer = match block_on(device, Renderer::with(device, queue, &pipelines, &settings))? {
                // The pool for all fragments of a slice is too large.
                Err(error) if is_too_large(&error) && redraw.halve() => continue,
                created => created?,
            };
            if let Some(lagged) = request.lagged {
                match block_on(device, renderer.resume_lagged(lagged))? {
                    Err(error) if is_too_large(&error) && redraw.halve() => continue,
                    resumed => resumed?,
                }
            }
            for (name, value) in &uniforms {
                renderer.set_uniform(name, *value)?;
            }
            for (name, opaque) in external.depths.iter().zip(opaque.iter().cycle()) {
                block_on(device, renderer.set_texture(name, &opaque.depths))??;
            }
            for (name, importance) in external.importance.iter().zip(importance.iter().cycle()) {
                block_on(device, renderer.set_texture(name, importance))??;
            }
            for (name, texture) in &textures {
                block_on(device, renderer.set_texture(name, texture))??;
            }
            if renderer.plan().passes.iter().any(|pass| pass.objects == Objects::Boxes) {
                block_on(device, renderer.set_objects(mesh.boxes()))??;
            }
            block_on(device, renderer.set_draws(mesh.draws()))??;
            redraw.frames += 1;
            let (frame, slices) = (redraw.frames, renderer.slices());
            progress.set_message(format!("{}: frame {frame}, slices: {slices}", request.description));
            redraw.rows = Some(height.div_ceil(slices));
            match self.frame(&mut renderer, scene, &mesh, (view.size, request.words)) {
                Ok(FrameOutcome::PoolExhausted { needed }) => redraw.pool_size = Some(needed),
                Ok(FrameOutcome::Complete(stats)) => break (stats, renderer),
                // The slice has more fragments than a buffer or the budget allows.
                Err(error) if is_too_large(&error) && redraw.halve() => {}
                Err(error) => return Err(error.into()),
            }
        };
        let result = RenderResult {
            stats,
            opaque: opaque.map(|opaque| opaque.pixels),
            device: self.headless.info.name.clone(),
            backend: self.headless.info.backend.to_string(),
            target: self.target.name,
            plan: self.shaders.plan.clone(),
            frames: redraw.frames,
        };
        Ok((result, GpuFrame { gpu: self, renderer, mesh, size: (width, height), offscreen: None }))
    }

    /// Renders the opaque scene on the same device.
    fn render_opaque(
        &self,
        task: &RenderTask<'_>,
        opaque: &OpaqueScene<'_>,
        registry: &Registry,
    ) -> Result<OpaqueImage, Failure> {
        task.progress.set_message("rendering the opaque scene".to_owned());
        let Headless { device, queue, .. } = &self.headless;
        let (width, height) = task.view.size;
        let request = Request { targets: &[&TARGETS[0]], form: Form::Program, prefix: "", group: 0 };
        let generation =
            generate(&opaque.variant, &request, registry).map_err(|errors| opaque.input.failure(errors))?;
        let shaders = Shaders::from_generation(&generation, TARGETS[0].name, 0)?;
        let geometry = geometry((&opaque.scene.scene, &[]), &shaders.plan, task.memory)?;
        let mesh = Mesh::upload(device, queue, &geometry, None)?;
        let memory = geometry.memory.without(task.view.image_bytes(IMAGE), "the image of the opaque scene")?.left();
        // In one slice: the next slice would clear the depth buffer of the former one.
        let settings = Settings { memory, slice: Some(height), ..Settings::new(BLENDED, width, height) };
        let mut renderer = block_on(device, Renderer::new(device, queue, &shaders, &settings))??;
        block_on(device, renderer.set_draws(mesh.draws()))??;
        match self.frame(&mut renderer, opaque.scene, &mesh, (task.view.size, &[]))? {
            FrameOutcome::Complete(FrameStats { pixels, .. }) => {
                let depths = renderer.texture(&depth_texture(&shaders.plan)?).cloned();
                let depths =
                    depths.ok_or_else(|| Failure::Device("the opaque scene has no depth buffer".to_owned()))?;
                Ok(OpaqueImage { pixels, depths })
            }
            FrameOutcome::PoolExhausted { .. } => {
                Err(Failure::Device("the opaque scene overflows its fragment pool".to_owned()))
            }
        }
    }

    /// Draws one frame and reads it back.
    fn frame(
        &self,
        renderer: &mut Renderer,
        scene: &SceneView,
        mesh: &Mesh,
        ((width, height), words): ((u32, u32), &[&str]),
    ) -> Result<FrameOutcome, Error> {
        let Headless { device, queue, .. } = &self.headless;
        renderer.set_camera(&scene.camera.view_projection);
        let offscreen = Offscreen::new(device, BLENDED, width, height)?;
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        let is_lagged = renderer.is_lagged();
        let loops = renderer.render(&output, &mut |pass, call| mesh.draw(pass, call))?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (counters, by_slice) = (renderer.counters(&mut encoder), renderer.slice_counters(&mut encoder));
        let times = renderer.pass_times(&mut encoder);
        let reports = renderer.loop_reports(&mut encoder);
        let words: Vec<_> = words.iter().map(|name| renderer.words(name, &mut encoder)).collect();
        queue.submit([encoder.finish()]);
        let words = words.into_iter().map(|pending| pending.map_or(Ok(Vec::new()), |pending| pending.wait(device)));
        let words = words.collect::<Result<Vec<_>, _>>()?;
        let counters = counters.map(|pending| pending.wait(device)).transpose()?;
        let by_slice = by_slice.map(|pending| pending.wait(device)).transpose()?;
        let times = times.map(|pending| pending.wait(device)).transpose()?;
        let loops = reports.map_or(Ok(loops), |pending| pending.wait(device))?;
        let overflow = by_slice.iter().flatten().map(|slice| slice.get(POOL_EXHAUSTED)).max().unwrap_or(0);
        if overflow > 0 {
            // Every fragment that did not fit was counted, so the count gives the size of the next pool.
            let needed = renderer.pool_size_after(overflow);
            let needed = u32::try_from(needed).map_err(|_| Error::TooLarge {
                what: "the pool for the image's fragments".to_owned(),
                needed,
                limit: u32::MAX.into(),
                limit_name: "fragments",
                help: "draw lower slices",
                shrinks_with_rows: true,
            })?;
            return Ok(FrameOutcome::PoolExhausted { needed });
        }
        let pixels = offscreen.colors(device, queue)?;
        let mut stats = FrameStats {
            pixels,
            counters,
            times,
            bytes: renderer.allocated_bytes(),
            slices: renderer.slices(),
            loops,
            k: renderer.k(),
            is_lagged,
            lagged: None,
            words,
        };
        // The image has been read back, so all words of the frame have, too.
        block_on(device, renderer.decide())??;
        stats.lagged = Some(renderer.lagged_values().clone());
        Ok(FrameOutcome::Complete(stats))
    }
}

/// Returns whether half as many rows may fit.
fn is_too_large(error: &Error) -> bool {
    matches!(error, Error::TooLarge { shrinks_with_rows: true, .. } | Error::OutOfMemory { .. } | Error::OverBudget(_))
}

/// The bytes per pixel of an image: four halves on the device, and four floats.
const IMAGE: u64 = 8 + 16;

/// The bytes per pixel of an [`OpaqueImage`].
const OPAQUE_IMAGE: u64 = 16 + 4;

/// The image of the opaque scene and its depth buffer.
struct OpaqueImage {
    pixels: Vec<[f32; 4]>,
    depths: wgpu::Texture,
}

/// The outcome of one frame.
enum FrameOutcome {
    /// The pool must hold `needed` fragments.
    PoolExhausted {
        needed: u32,
    },
    Complete(FrameStats),
}
