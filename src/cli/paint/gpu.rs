//! The frame on a GPU, or on whatever wgpu has an adapter for.
//!
//! In: a task and the adapter that is meant. Out: what was painted, drawn again with more room until nothing is lost for want
//! of it, in slices as high as the device has memory for.

use fragbuf::{Form, Registry, Request, TARGETS, Target, generate, tier};
use fragbuf_frame::{POOL_EXHAUSTED, Room, Sizing};
use fragbuf_runtime::headless::{BLENDED, Choice, Headless, Offscreen};
use fragbuf_runtime::wgpu;
use fragbuf_runtime::{Error, Output, Pipelines, Renderer, Settings, Shaders, block_on};

use super::opaque::{Opaque, brought, depths};
use super::{Figures, Painted, Task};
use crate::cli::attributes::{Geometry, geometry};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::uniforms;
use crate::cli::view::Stage;

pub(super) fn paint(
    task: &Task<'_>,
    choice: &Choice,
    (input, registry): (&Input, &Registry),
    progress: (&mut u32, &mut Option<u32>),
) -> Result<Painted, Failure> {
    let painter = Painter::new(task, choice, input, registry)?;
    let backdrop = task.opaque.map(|opaque| painter.backdrop(task, opaque, registry)).transpose()?;
    painter.paint(task, backdrop, progress)
}

/// A device, and the shaders for it.
struct Painter {
    headless: Headless,
    shaders: Shaders,
    target: &'static Target,
}

impl Painter {
    /// The soundest of the languages that can be run here.
    fn new(task: &Task<'_>, choice: &Choice, input: &Input, registry: &Registry) -> Result<Self, Failure> {
        let targets: Vec<&'static Target> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(task.variant, &request, registry).map_err(|faults| input.failure(faults))?;
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
            match Headless::open(choice, shaders.features()) {
                Ok(headless) => match shaders.check_interlock(headless.interlock) {
                    Ok(()) => return Ok(Painter { headless, shaders, target }),
                    Err(error) => refusal = error.into(),
                },
                Err(error @ Error::MissingFeatures(_)) => refusal = error.into(),
                Err(error) => return Err(error.into()),
            }
        }
        Err(refusal)
    }

    /// Draws the picture until nothing is lost for want of room, in slices as high as the device has memory for.
    fn paint(
        self,
        task: &Task<'_>,
        backdrop: Option<Backdrop>,
        (frames, room): (&mut u32, &mut Option<u32>),
    ) -> Result<Painted, Failure> {
        let Task { wish, view, stage, progress, variant, opaque } = task;
        let brought = brought(&self.shaders.plan, *opaque)?;
        let (width, height) = view.size;
        let Headless { device, queue, .. } = &self.headless;
        progress.stage(format!("{}: making pipelines", wish.description));
        let mesh = Mesh::upload(device, queue, &geometry(&stage.scene, &self.shaders.plan)?)?;
        let settings = Settings {
            timestamps: view.json,
            interlock: self.headless.interlock,
            ..Settings::new(BLENDED, width, height)
        };
        let pipelines = block_on(device, Pipelines::new(device, &self.shaders, &settings))??;
        let uniforms = uniforms::values(wish.uniforms, variant)?;
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
            for (name, backdrop) in brought.iter().zip(backdrop.iter().cycle()) {
                block_on(device, renderer.set_texture(name, &backdrop.depths))??;
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
            behind: backdrop.map(|backdrop| backdrop.pixels),
            device: self.headless.info.name.clone(),
            backend: self.headless.info.backend.to_string(),
            target: self.target.name,
            plan: self.shaders.plan,
            frames: *frames,
        })
    }

    /// Draws what is opaque, on the same device.
    fn backdrop(&self, task: &Task<'_>, opaque: &Opaque<'_>, registry: &Registry) -> Result<Backdrop, Failure> {
        task.progress.stage("drawing what is opaque".to_owned());
        let Headless { device, queue, .. } = &self.headless;
        let (width, height) = task.view.size;
        let request = Request { targets: &[&TARGETS[0]], form: Form::Program, prefix: "", group: 0 };
        let generation =
            generate(&opaque.variant, &request, registry).map_err(|faults| opaque.input.failure(faults))?;
        let shaders = Shaders::from_generation(&generation, TARGETS[0].name, 0)?;
        let mesh = Mesh::upload(device, queue, &geometry(&opaque.stage.scene, &shaders.plan)?)?;
        let settings = Settings::new(BLENDED, width, height);
        let mut renderer = block_on(device, Renderer::new(device, queue, &shaders, &settings))??;
        match self.frame(&mut renderer, opaque.stage, &mesh, task.view.size)? {
            Drawn::Whole(Figures { pixels, .. }) => {
                let depths = renderer.texture(&depths(&shaders.plan)?).cloned();
                let depths = depths.ok_or_else(|| Failure::Device("the opaque surfaces leave no depths".to_owned()))?;
                Ok(Backdrop { pixels, depths })
            }
            Drawn::Short(_) => Err(Failure::Device("there is no room for the opaque surfaces".to_owned())),
        }
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
        let loops = renderer.render(&output, &mut |pass, _| mesh.draw(pass))?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (counters, each) = (renderer.counters(&mut encoder), renderer.slice_counters(&mut encoder));
        let times = renderer.pass_times(&mut encoder);
        queue.submit([encoder.finish()]);
        let counters = counters.map(|pending| pending.wait(device)).transpose()?;
        let each = each.map(|pending| pending.wait(device)).transpose()?;
        let times = times.map(|pending| pending.wait(device)).transpose()?;
        let short = each.iter().flatten().map(|slice| slice.get(POOL_EXHAUSTED)).max().unwrap_or(0);
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
            loops,
        }))
    }
}

/// What is opaque, drawn.
struct Backdrop {
    pixels: Vec<[f32; 4]>,
    depths: wgpu::Texture,
}

/// What one frame came to.
enum Drawn {
    /// Room for so many fragments is needed.
    Short(u32),
    Whole(Figures),
}

/// The scene on the device.
struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Mesh {
    fn upload(device: &wgpu::Device, queue: &wgpu::Queue, geometry: &Geometry) -> Result<Self, Failure> {
        let buffer = |label: &str, words: &[u32], usage: wgpu::BufferUsages| {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
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
            queue.write_buffer(&buffer, 0, &bytes);
            Ok(buffer)
        };
        Ok(Mesh {
            vertices: buffer("vertices", &geometry.vertices, wgpu::BufferUsages::VERTEX)?,
            indices: buffer("indices", &geometry.indices, wgpu::BufferUsages::INDEX)?,
            count: geometry.indices.len() as u32,
        })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}
