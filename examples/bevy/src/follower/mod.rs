//! Follows a manifest on the device of Bevy's render world.
//!
//! Input: generated passes, a device and its queue, what is drawn (`Geometry`), a view to draw into. Output: submitted commands, and the
//! counters of a frame. It contains no name of a technique or a pass. `fragbuf_follow` walks through the steps; here `requirements`
//! compares a device with the manifest, `names` translates its words, `memory` creates buffers and textures, `layouts` and `pipelines`
//! create what passes need, and `frame` with `drawing` and `readback` carries out the steps. Nothing here knows a component of Bevy.

mod counters;
mod drawing;
mod frame;
mod layouts;
mod memory;
mod names;
mod pipelines;
mod readback;
mod requirements;

use std::collections::BTreeMap;
use std::sync::Arc;

use bevy::tasks::block_on;
use fragbuf_follow::manifest::{File, Manifest, Plan};
use fragbuf_follow::{Error, Scene, Uniforms, Values, Walk};

use crate::Passes;
use frame::Frame;
use memory::Memory;
use pipelines::{Pipelines, Source};

pub use counters::{CounterNames, Counters};
pub use drawing::{Geometry, GeometryDraw};
pub use layouts::{Attachments, PassLayout, sample_formula};
pub use memory::texture_bytes;
pub use names::{depth_stencil, targets};
pub use readback::{staging, wait};

/// A device, and the queue to which its commands are submitted.
#[derive(Clone)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// What a frame is drawn into, and how.
pub struct Output<'a> {
    /// A view as large as the frame, of the format that [`Follower::new`] was given.
    pub view: &'a wgpu::TextureView,
    /// The colour that the frame begins with; `None`: what is there.
    pub clear: Option<wgpu::Color>,
    /// Submits commands in the middle of a frame, after everything that must run before them.
    pub submit: &'a mut dyn FnMut(wgpu::CommandBuffer),
}

/// A plan on a device, with memory for one size of the frame.
pub struct Follower {
    gpu: Gpu,
    /// The name of the buffer.
    name: String,
    plan: Arc<Plan>,
    files: Vec<File>,
    /// The values of symbols.
    values: Values,
    walk: Walk,
    uniforms: Uniforms,
    layouts: Vec<Option<PassLayout>>,
    pipelines: Pipelines,
    memory: Memory,
    size: [u32; 2],
}

impl Follower {
    /// Checks what the device lacks, compiles every pass in program form, and prepares frames of this size. Geometry passes in module
    /// form have no pipeline here: the caller creates them with the layouts of [`Self::layouts`].
    pub fn new(gpu: &Gpu, passes: &Passes, size: [u32; 2], output: wgpu::TextureFormat) -> Result<Self, Error> {
        let (files, plan) = Manifest::parse(&passes.manifest, crate::TARGET)?;
        let plan = Arc::new(plan);
        requirements::check_size(&gpu.device, size)?;
        let values = Values::new(plan.clone(), size);
        requirements::check(&gpu.device, &plan, &values)?;
        let layouts = layouts::create(&gpu.device, &plan)?;
        let (device, layouts_of) = (&gpu.device, &layouts);
        let source =
            Source { device, plan: &plan, values: &values, files: &files, passes, layouts: layouts_of, output };
        Ok(Follower {
            pipelines: Pipelines::new(&source)?,
            layouts,
            memory: Memory::new(gpu),
            walk: Walk::new(plan.clone()),
            uniforms: Uniforms::new(&plan),
            gpu: gpu.clone(),
            name: passes.name.clone(),
            files,
            values,
            size,
            plan,
        })
    }

    /// The plan that is followed.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The values of symbols.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The files of a pass.
    pub fn files(&self, pass: &str) -> impl Iterator<Item = &File> {
        self.files.iter().filter(move |file| file.pass == pass)
    }

    /// What each pass binds, by the index of its step; `None` for other steps.
    pub fn layouts(&self) -> &[Option<PassLayout>] {
        &self.layouts
    }

    /// Sets a symbol, such as `k`, from the next frame on.
    pub fn set_symbol(&mut self, name: &str, value: u64) -> Result<(), Error> {
        self.values.set(name, value)
    }

    /// Sets a uniform of the description: four bytes per component.
    pub fn set_uniform(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.uniforms.set(name, bytes)
    }

    /// Sets a texture that the engine supplies. It must have the format and the size that [`Self::texture_descriptor`] returns.
    pub fn set_texture(&mut self, name: &str, texture: &wgpu::Texture) -> Result<(), Error> {
        let wanted = self.texture_descriptor(name)?;
        let given = (texture.format(), texture.size());
        if given != (wanted.format, wanted.size) {
            return Err(Error(format!(
                "the texture `{name}` is {given:?}: it must be {:?}",
                (wanted.format, wanted.size)
            )));
        }
        self.memory.supply(name, texture);
        Ok(())
    }

    /// Describes a texture that the engine supplies, with the usage that passes need.
    pub fn texture_descriptor(&self, name: &str) -> Result<wgpu::TextureDescriptor<'static>, Error> {
        let resource = self.plan.resources.iter().find(|resource| resource.name == name && resource.init == "external");
        let texture = resource.and_then(|resource| resource.texture.as_ref());
        let texture = texture.ok_or_else(|| Error(format!("the plan has no external texture `{name}`")))?;
        memory::describe(texture, &self.values, self.size)
    }

    /// The textures that the engine supplies, such as the depth of its opaque surfaces.
    pub fn external_textures(&self) -> impl Iterator<Item = &str> {
        self.plan.resources.iter().filter(|resource| resource.init == "external").map(|resource| resource.name.as_str())
    }

    /// Records a frame, and submits its parts where the host must read words. Returns the last part, which the caller submits.
    pub fn draw(
        &mut self,
        output: Output<'_>,
        geometry: &dyn Geometry,
        scene: &Scene<'_>,
    ) -> Result<wgpu::CommandBuffer, Error> {
        if let Some(missing) = self.external_textures().find(|name| self.memory.texture(name).is_err()) {
            return Err(Error(format!("`{missing}` is a texture of the engine: set it before the frame")));
        }
        self.uniforms.bytes()?;
        self.values.begin_slice(0, self.size[1]);
        self.memory.allocate(&self.plan, &self.values, self.size)?;
        let mut frame = Frame {
            gpu: &self.gpu,
            plan: &self.plan,
            layouts: &self.layouts,
            pipelines: &self.pipelines,
            uniforms: &self.uniforms,
            memory: &mut self.memory,
            size: self.size,
            output,
            geometry,
            view_projection: scene.view_projection,
            encoder: None,
            queries: BTreeMap::new(),
        };
        let swapped = self.walk.run(&mut self.values, (scene, self.size), &mut frame)?;
        let commands = frame.finish();
        self.walk.end_frame(swapped);
        Ok(commands)
    }

    /// Waits for everything that has been submitted, and returns the counters of the last frame.
    pub fn counters(&self) -> Result<Counters, Error> {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("counters") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let Some(words) = self.copy_counters(&mut encoder) else { return Ok(Counters::default()) };
        self.gpu.queue.submit([encoder.finish()]);
        Ok(self.counter_names().counters(&wait(&self.gpu, &words)?))
    }

    /// Records a copy of the words of the counters. `None`: the plan counts nothing, or no frame has been drawn.
    pub fn copy_counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<wgpu::Buffer> {
        let buffer = self.memory.buffer("counters").ok().filter(|_| !self.plan.counters.is_empty())?;
        let words = staging(&self.gpu.device, buffer.size());
        encoder.copy_buffer_to_buffer(buffer, 0, &words, 0, buffer.size());
        Some(words)
    }

    /// The names of the words of the counters.
    pub fn counter_names(&self) -> CounterNames {
        CounterNames { buffer: self.name.clone(), plan: self.plan.clone() }
    }

    /// The bytes of the buffers and textures of the plan, without those of the engine.
    pub fn bytes(&self) -> u64 {
        self.memory.bytes(&self.plan)
    }
}

/// Runs what may raise a validation error or exhaust memory. Returns the error as one that names what was created.
fn scoped<T>(device: &wgpu::Device, what: &str, create: impl FnOnce() -> T) -> Result<T, Error> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let created = create();
    let error = block_on(validation.pop());
    let error = error.or(block_on(memory.pop()));
    error.map_or(Ok(created), |error| Err(Error(format!("{what}: {error}"))))
}
