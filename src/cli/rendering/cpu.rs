//! Renders a task on the CPU device, which needs no driver.
//!
//! Input: a task and the order of fragments. Output: the result, redrawn with a larger pool until no fragment is lost to
//! overflow, in slices as high as the memory budget allows.

use std::sync::Arc;

use fragbuf::{Diagnostics, Registry};
use fragbuf_cpu::{Code, Device, Error, FragmentOrder, Mesh, Settings};
use fragbuf_frame::{POOL_EXHAUSTED, PoolSize, Sizing};

use super::external::ExternalTextures;
use super::importance::Importance;
use super::opaque::{OpaqueScene, depth_texture};
use super::prepared::FrameTime;
use super::request::{RedrawState, RenderTask};
use super::result::{FrameStats, RenderResult};
use super::textures;
use crate::cli::attributes::{Geometry, geometry};
use crate::cli::device::CPU;
use crate::cli::input::Input;
use crate::cli::output::{Failure, warn};
use crate::cli::uniforms;

/// The bytes per pixel of an [`OpaqueImage`].
const OPAQUE_IMAGE: u64 = 16 + 4;

/// A device with the geometry of a scene, to draw the frame again.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
pub(crate) struct CpuFrame {
    device: Device,
    geometry: Geometry,
}

#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
impl CpuFrame {
    /// Draws the frame again.
    pub(super) fn draw(&mut self) -> Result<FrameTime, Failure> {
        let mesh = Mesh { vertices: &self.geometry.vertices, indices: &self.geometry.indices };
        let device = &mut self.device;
        FrameTime::measure(|| Ok(device.render(&mesh, &|_| {})?.times))
    }
}

/// Renders the task. Returns the frame, too, which can be drawn again.
pub(super) fn render(
    task: &RenderTask<'_>,
    order: FragmentOrder,
    (input, registry): (&Input, &Registry),
    redraw: &mut RedrawState,
) -> Result<(RenderResult, CpuFrame), Failure> {
    let RenderTask { request, view, scene, progress, variant, opaque, memory } = task;
    progress.set_message(format!("{}: compiling", request.description));
    let code = Code::of(variant, registry).map_err(|error| failure(error, |errors| input.failure(errors)))?;
    let code = Arc::new(code);
    let external = ExternalTextures::of(&code.plan, view, *opaque)?;
    let opaque = opaque.map(|opaque| render_opaque(task, opaque, order, registry)).transpose()?;
    let geometry = geometry((&scene.scene, &view.attributes), &code.plan, *memory)?;
    let mesh = Mesh { vertices: &geometry.vertices, indices: &geometry.indices };
    let opaque_bytes = if opaque.is_some() { view.image_bytes(OPAQUE_IMAGE) } else { 0 };
    let memory = geometry.memory.without(opaque_bytes, "the image of the opaque scene")?;
    let importance = view.importance.as_ref().filter(|_| !external.importance.is_empty());
    let importance = importance.map(|path| Importance::read(path, view.size, memory)).transpose()?;
    let memory = importance.as_ref().map_or(memory, |importance| importance.memory);
    let (textures, memory) = textures::read(variant, &view.textures, memory)?;
    let memory = memory.left();
    let uniforms = uniforms::values(request.uniforms, variant, scene)?;
    let (width, height) = view.size;
    loop {
        let sizing =
            redraw.pool_size.map_or(Sizing::Auto, |fragments| Sizing::Capacity(PoolSize::Fragments(fragments)));
        let settings = Settings {
            sizing,
            decisions: view.decisions,
            conditions: view.loops.conditions(),
            order,
            slice: redraw.slice,
            memory,
            ..Settings::new(width, height)
        };
        let mut device = match Device::new(code.clone(), settings) {
            // The pool for all fragments of a slice is too large.
            Err(error) if is_too_large(&error) && redraw.halve() => continue,
            created => created?,
        };
        match request.lagged.map_or(Ok(()), |lagged| device.resume_lagged(lagged)) {
            Err(error) if is_too_large(&error) && redraw.halve() => continue,
            resumed => resumed?,
        }
        redraw.rows = Some(height.div_ceil(device.slices()));
        for (name, value) in &uniforms {
            device.set_uniform(name, *value)?;
        }
        for (name, opaque) in external.depths.iter().zip(opaque.iter().cycle()) {
            device.set_texture(name, &opaque.depths)?;
        }
        for (name, importance) in external.importance.iter().zip(importance.iter().cycle()) {
            device.set_texture(name, &importance.values)?;
        }
        for texture in &textures {
            device.set_description_texture(&texture.name, texture.size, &texture.texels)?;
        }
        device.set_objects(&geometry.objects);
        device.set_camera(&scene.camera.view_projection);
        redraw.frames += 1;
        let frame = redraw.frames;
        let drawn = device.render(&mesh, &|now| {
            progress.set_fraction(|| format!("{}: frame {frame}, pass {}", request.description, now.pass), now.share);
        });
        let picture = match drawn {
            // The slice has more fragments than the budget allows.
            Err(error) if is_too_large(&error) && redraw.halve() => continue,
            drawn => drawn?,
        };
        let overflow = picture.slice_counters.iter().map(|counters| counters.get(POOL_EXHAUSTED)).max().unwrap_or(0);
        if overflow > 0 {
            // Every fragment that did not fit was counted, so the count gives the size of the next pool.
            let needed = device.pool_size_after(overflow);
            match u32::try_from(needed) {
                Ok(fragments) => redraw.pool_size = Some(fragments),
                Err(_) if redraw.halve() => {}
                Err(_) => return Err(Failure::Device(format!("{needed} fragments in one row are too many"))),
            }
            continue;
        }
        for pass in &picture.out_of_bounds {
            warn(&format!("{}: pass `{pass}` goes out of the bounds of a buffer or an array", request.description));
        }
        let stats = FrameStats {
            pixels: picture.pixels,
            counters: picture.counters,
            times: view.json.then_some(picture.times),
            bytes: device.allocated_bytes(),
            slices: device.slices(),
            loops: picture.loops,
            k: device.symbol("k").and_then(|k| u32::try_from(k).ok()).filter(|_| code.plan.variant.keep.is_some()),
            is_lagged: device.is_lagged(),
            lagged: Some(device.lagged_values()),
            words: request.words.iter().map(|name| device.words(name).unwrap_or_default()).collect(),
        };
        let result = RenderResult {
            stats,
            opaque: opaque.map(|opaque| opaque.pixels),
            device: CPU.to_owned(),
            backend: "interpreter".to_owned(),
            target: "wgsl-native",
            plan: code.plan.clone(),
            frames: redraw.frames,
        };
        return Ok((result, CpuFrame { device, geometry }));
    }
}

/// Returns whether half as many rows may fit.
fn is_too_large(error: &Error) -> bool {
    use fragbuf_frame::Error as FrameError;
    let is_size = |error: &FrameError| {
        matches!(error, FrameError::TooLarge { shrinks_with_rows: true, .. } | FrameError::OverBudget(_))
    };
    matches!(error, Error::OutOfMemory { .. }) || matches!(error, Error::Frame(error) if is_size(error))
}

/// The image of the opaque scene and its depth buffer.
struct OpaqueImage {
    pixels: Vec<[f32; 4]>,
    /// Row after row.
    depths: Vec<f32>,
}

/// Renders the opaque scene.
fn render_opaque(
    task: &RenderTask<'_>,
    opaque: &OpaqueScene<'_>,
    order: FragmentOrder,
    registry: &Registry,
) -> Result<OpaqueImage, Failure> {
    task.progress.set_message("rendering the opaque scene".to_owned());
    let code =
        Code::of(&opaque.variant, registry).map_err(|error| failure(error, |errors| opaque.input.failure(errors)))?;
    let code = Arc::new(code);
    let geometry = geometry((&opaque.scene.scene, &[]), &code.plan, task.memory)?;
    let (width, height) = task.view.size;
    let depths = task.view.image_bytes(size_of::<f32>() as u64);
    let memory = geometry.memory.without(depths, "the depth buffer of the opaque scene")?.left();
    let mut device = Device::new(code.clone(), Settings { order, memory, ..Settings::new(width, height) })?;
    device.set_camera(&opaque.scene.camera.view_projection);
    let mesh = Mesh { vertices: &geometry.vertices, indices: &geometry.indices };
    let pixels = device.render(&mesh, &|_| {})?.pixels;
    let words = device.words(&depth_texture(&code.plan)?).unwrap_or_default();
    Ok(OpaqueImage { pixels, depths: words.into_iter().map(f32::from_bits).collect() })
}

/// Converts an error; diagnostics get their sources from `with_sources`.
fn failure(error: Error, with_sources: impl FnOnce(Diagnostics) -> Failure) -> Failure {
    match error {
        Error::Diagnostics(diagnostics) => with_sources(diagnostics),
        other => other.into(),
    }
}
