//! The Vulkan objects of one plan, and their use by the steps of a frame.
//!
//! Input: a plan, its files, and the steps that `fragbuf_follow::Walk` hands over. Output: recorded commands, with a
//! barrier before each use that needs one. Loops, conditions and values of symbols are decided there, not here.

use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use ash::vk;
use fragbuf_follow::manifest::{File, Kind, Pass, Plan};
use fragbuf_follow::{Call, Device, Scene, Uniforms, Values};

use crate::access::Access;
use crate::attachments::{Attachments, render_pass, sample_formula};
use crate::bindings::{Blocks, Cache};
use crate::context::Context;
use crate::gpu::Gpu;
use crate::memory::{Buffer, HostAccess, Memory, Texture};
use crate::names::{formats, samples};
use crate::pipeline::{Pipeline, compute, graphics};
use crate::queries::Queries;
use crate::recorder::Recorder;
use crate::shaders::Shaders;
use crate::{Error, OUTPUT, copies};

/// The formats of the image, the most precise first. Every device blends the second.
const OUTPUT_FORMATS: [vk::Format; 2] = [vk::Format::R32G32B32A32_SFLOAT, vk::Format::R16G16B16A16_SFLOAT];

/// A pass with its pipelines, by sample count and sample mask.
pub struct PassObjects {
    pub shaders: Shaders,
    pub attachments: Attachments,
    pipelines: BTreeMap<(u64, u32), Pipeline>,
}

/// The Vulkan objects of one plan. They are dropped before the device, which each of them holds.
pub struct Engine<'c> {
    context: &'c Context,
    pub plan: Arc<Plan>,
    pub size: [u32; 2],
    pub recorder: Recorder,
    pub cache: Cache,
    pub queries: Queries,
    pub passes: BTreeMap<usize, PassObjects>,
    pub blocks: Blocks,
    /// The memory of resources, and of the image as [`OUTPUT`].
    pub memory: BTreeMap<String, Memory>,
    /// The vertices of the scene, and those of its boxes.
    pub vertices: [Option<Buffer>; 2],
    pub gpu: Rc<Gpu>,
}

impl<'c> Engine<'c> {
    /// Loads the files of every pass.
    pub fn new(
        context: &'c Context,
        gpu: Gpu,
        (plan, files): (Arc<Plan>, &[File]),
        read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let gpu = Rc::new(gpu);
        let passes = plan.passes().map(|(step, pass)| {
            let shaders = Shaders::new(&gpu, pass, files, read)?;
            let attachments = Attachments::of(&plan, pass);
            Ok((step, PassObjects { shaders, attachments, pipelines: BTreeMap::new() }))
        });
        Ok(Engine {
            context,
            size,
            passes: passes.collect::<Result<_, Error>>()?,
            recorder: Recorder::new(&gpu)?,
            cache: Cache::new(&gpu),
            queries: Queries::new(&gpu),
            blocks: Blocks::new(&gpu, &plan)?,
            memory: BTreeMap::new(),
            vertices: [None, None],
            plan,
            gpu,
        })
    }

    /// Forgets all memory, because a frame was not finished or has another size.
    pub fn reset(&mut self, size: [u32; 2]) -> Result<(), Error> {
        self.recorder.discard();
        self.cache.clear();
        // Queries that have not been submitted never end.
        self.queries = Queries::new(&self.gpu);
        self.memory.clear();
        self.blocks = Blocks::new(&self.gpu, &self.plan)?;
        self.size = size;
        Ok(())
    }

    /// Uploads the vertices of a scene, and its boxes if a pass draws them.
    pub fn upload(&mut self, scene: &Scene<'_>, boxes: &[u8]) -> Result<(), Error> {
        for (slot, bytes) in self.vertices.iter_mut().zip([scene.vertices, boxes]) {
            if slot.as_ref().is_none_or(|buffer| buffer.bytes < bytes.len() as u64) {
                let (usage, access) = (vk::BufferUsageFlags::VERTEX_BUFFER, HostAccess::Write);
                *slot = None;
                *slot = Some(Buffer::new(&self.gpu, "the vertices", bytes.len() as u64, usage, access)?);
            }
            slot.iter_mut().for_each(|buffer| buffer.write(bytes));
        }
        Ok(())
    }

    /// Creates the memory of every resource whose size is known and has changed, and of the image. New memory is zero.
    pub fn allocate(&mut self, values: &Values) -> Result<(), Error> {
        if !self.memory.contains_key(OUTPUT) {
            let kind = (&OUTPUT_FORMATS[..], vk::SampleCountFlags::TYPE_1, true);
            let image = Texture::new(self.context, &self.gpu, "the image", kind, self.size)?;
            self.memory.insert(OUTPUT.to_owned(), Memory::Texture(image));
        }
        let plan = self.plan.clone();
        for resource in plan.resources.iter().filter(|resource| resource.init != "external") {
            let what = format!("`{}`", resource.name);
            let created = match &resource.texture {
                Some(_) if self.memory.contains_key(&resource.name) => continue,
                Some(_) => Memory::Texture(self.texture(&resource.name, values)?),
                None => {
                    // A host step has yet to decide the size.
                    let Ok(bytes) = values.bytes(resource) else { continue };
                    let fits = |present: &Buffer| (bytes..=bytes.saturating_mul(2)).contains(&present.bytes);
                    match self.memory.get(&resource.name) {
                        Some(Memory::Buffer(buffer)) if fits(buffer) => continue,
                        _ => self.replace(&resource.name)?,
                    }
                    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
                        | vk::BufferUsageFlags::INDIRECT_BUFFER
                        | vk::BufferUsageFlags::TRANSFER_SRC
                        | vk::BufferUsageFlags::TRANSFER_DST;
                    Memory::Buffer(Buffer::new(&self.gpu, &what, bytes, usage, HostAccess::None)?)
                }
            };
            self.memory.insert(resource.name.clone(), created);
            self.clear(&resource.name, 0, None)?;
        }
        Ok(())
    }

    /// Frees memory that is to be replaced, once the device no longer uses it.
    fn replace(&mut self, name: &str) -> Result<(), Error> {
        if self.memory.contains_key(name) {
            self.recorder.finish()?;
            self.cache.clear();
            self.memory.remove(name);
        }
        Ok(())
    }

    /// Creates the texture of a resource.
    pub fn texture(&self, name: &str, values: &Values) -> Result<Texture, Error> {
        let texture = self.plan.resource(name).and_then(|resource| resource.texture.as_ref());
        let texture = texture.ok_or_else(|| Error(format!("`{name}` is no texture")))?;
        let is_blended = self.plan.passes().flat_map(|(_, pass)| &pass.state.targets);
        let is_blended = is_blended.filter(|target| target.resource == name).any(|target| target.blend.is_some());
        let kind = (formats(&texture.format)?, samples(values.value(&texture.samples, 0)?)?, is_blended);
        Texture::new(self.context, &self.gpu, &format!("`{name}`"), kind, self.size)
    }

    /// Returns memory, or an error that says which symbol would give it its size.
    pub fn memory_of(&mut self, name: &str, values: &Values) -> Result<&mut Memory, Error> {
        if !self.memory.contains_key(name) {
            let resource = self.plan.resource(name);
            let resource = resource.ok_or_else(|| Error(format!("there is no resource `{name}`")))?;
            if resource.init == "external" {
                return Err(Error(match resource.described() {
                    Some((name, _)) => format!("the description reads the texture `{name}`: set it with `set_texels`"),
                    None => format!("the plan reads the external texture `{name}`: set it with `set_texture`"),
                }));
            }
            values.bytes(resource).map_err(|error| Error(format!("`{name}` has no memory: {error}")))?;
        }
        self.memory.get_mut(name).ok_or_else(|| Error(format!("`{name}` has no memory")))
    }

    /// Returns a pass with the pipeline for these samples, which is created once.
    pub fn pipeline(
        &mut self,
        pass: &Pass,
        call: &Call<'_>,
    ) -> Result<(&PassObjects, vk::Pipeline, vk::RenderPass), Error> {
        let objects = self.passes.get(&call.step);
        let objects = objects.ok_or_else(|| Error(format!("the pass `{}` has not been loaded", pass.name)))?;
        let count = call.value(sample_formula(&self.plan, pass, &objects.attachments))?;
        let mask = match &pass.state.samples {
            Some(samples) => call.value(&samples.mask)? as u32,
            None => u32::MAX,
        };
        if !objects.pipelines.contains_key(&(count, mask)) {
            let created = match pass.kind {
                Kind::Compute => compute(&self.gpu, pass, &objects.shaders)?,
                Kind::Fullscreen | Kind::Geometry => self.graphics(pass, call, objects, (count, mask))?,
            };
            self.passes.entry(call.step).and_modify(|objects| {
                objects.pipelines.insert((count, mask), created);
            });
        }
        let objects = &self.passes[&call.step];
        let pipeline = &objects.pipelines[&(count, mask)];
        Ok((objects, pipeline.pipeline, pipeline.render_pass))
    }

    fn graphics(
        &self,
        pass: &Pass,
        call: &Call<'_>,
        objects: &PassObjects,
        (count, mask): (u64, u32),
    ) -> Result<Pipeline, Error> {
        let samples = samples(count)?;
        let format = |name: &str| match self.memory.get(call.resource(name)) {
            Some(Memory::Texture(texture)) => Ok(texture.format),
            _ => Err(Error(format!("the pass `{}` attaches `{name}`, which is no texture", pass.name))),
        };
        let formats = objects.attachments.names().map(format).collect::<Result<Vec<_>, Error>>()?;
        let no_attachments = self.gpu.limits.framebuffer_no_attachments_sample_counts;
        if formats.is_empty() && !no_attachments.contains(samples) {
            return Err(Error(format!(
                "the device has no passes without attachments and with {count} samples per pixel"
            )));
        }
        let render_pass = render_pass(&self.gpu, &objects.attachments, &formats, samples)?;
        graphics(&self.gpu, (pass, &objects.shaders), render_pass, &self.plan.vertex_inputs, (samples, mask))
    }

    /// Records a clear.
    pub fn clear(&mut self, name: &str, value: u32, texel: Option<&serde_json::Value>) -> Result<(), Error> {
        let memory = self.memory.get_mut(name).ok_or_else(|| Error(format!("`{name}` has no memory yet")))?;
        self.recorder.transition(memory, Access::COPY_TARGET)?;
        let commands = self.recorder.commands()?;
        copies::clear(&self.gpu.device, commands, memory, value, texel);
        Ok(())
    }
}

/// A frame that is under way: the engine and what the caller draws.
pub struct Frame<'e, 'c> {
    pub engine: &'e mut Engine<'c>,
    pub scene: &'e Scene<'e>,
    pub uniforms: &'e Uniforms,
}

impl Device for Frame<'_, '_> {
    fn clear(&mut self, resource: &str, value: u32, texel: Option<&serde_json::Value>) -> Result<(), Error> {
        self.engine.clear(resource, value, texel)?;
        self.engine.recorder.end_step()
    }

    fn copy(&mut self, from: &str, to: &str) -> Result<(), Error> {
        let engine = &mut *self.engine;
        for (name, access) in [(from, Access::COPY_SOURCE), (to, Access::COPY_TARGET)] {
            let memory = engine.memory.get_mut(name).ok_or_else(|| Error(format!("`{name}` has no memory yet")))?;
            engine.recorder.transition(memory, access)?;
        }
        let commands = engine.recorder.commands()?;
        copies::copy(&engine.gpu.device, commands, [&engine.memory[from], &engine.memory[to]])?;
        engine.recorder.end_step()
    }

    fn pass(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        self.record(pass, call)?;
        self.engine.recorder.end_step()
    }

    fn words(&mut self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        self.engine.words(resource, first, count)
    }

    fn samples(&mut self, pass: &str) -> Result<Vec<u64>, Error> {
        self.engine.recorder.finish()?;
        self.engine.queries.samples(pass)
    }

    fn allocate(&mut self, values: &Values) -> Result<(), Error> {
        self.engine.allocate(values)
    }
}
