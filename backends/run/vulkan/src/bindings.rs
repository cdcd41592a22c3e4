//! What passes bind: uniform blocks with their content, descriptor sets and framebuffers.

use std::collections::BTreeMap;
use std::rc::Rc;

use ash::vk;
use fragbuf_follow::manifest::{Binding, BindingKind, Plan};

use crate::Error;
use crate::access::Access;
use crate::context::failed;
use crate::gpu::Gpu;
use crate::memory::{Buffer, HostAccess, Memory, Texture};
use crate::names::{aspects, is_depth};
use crate::recorder::Recorder;
use crate::shaders::{Shaders, descriptor_type};

/// The uniform blocks of a plan: a buffer each, which is written between passes.
pub struct Blocks {
    blocks: BTreeMap<String, (Buffer, Vec<u8>)>,
}

const UNIFORM: Access = Access::new(
    vk::PipelineStageFlags::from_raw(
        vk::PipelineStageFlags::VERTEX_SHADER.as_raw()
            | vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw()
            | vk::PipelineStageFlags::COMPUTE_SHADER.as_raw(),
    ),
    vk::AccessFlags::UNIFORM_READ,
    vk::ImageLayout::UNDEFINED,
);

impl Blocks {
    pub fn new(gpu: &Rc<Gpu>, plan: &Plan) -> Result<Self, Error> {
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let created = plan.uniform_blocks.iter().map(|block| {
            let what = format!("the uniform block `{}`", block.name);
            let buffer = Buffer::new(gpu, &what, block.bytes as u64, usage, HostAccess::None)?;
            Ok((block.name.clone(), (buffer, Vec::new())))
        });
        Ok(Blocks { blocks: created.collect::<Result<_, Error>>()? })
    }

    /// Records that a block gets this content, if it has another.
    pub fn write(&mut self, gpu: &Gpu, recorder: &mut Recorder, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let Some((buffer, content)) = self.blocks.get_mut(name).filter(|(_, content)| content != bytes) else {
            return Ok(());
        };
        let (before, after) = (buffer.state.change(Access::COPY_TARGET, false), buffer.state.change(UNIFORM, false));
        recorder.barriers(&before.map(|barrier| (barrier, None)).into_iter().collect::<Vec<_>>())?;
        let commands = recorder.commands()?;
        // SAFETY: the buffer is as large as the block, which `Manifest::parse` limits to what the command writes, in
        // whole words, and no render pass is open.
        unsafe { gpu.device.cmd_update_buffer(commands, buffer.buffer, 0, bytes) };
        bytes.clone_into(content);
        recorder.barriers(&after.map(|barrier| (barrier, None)).into_iter().collect::<Vec<_>>())
    }
}

/// Descriptor sets and framebuffers by what they refer to. They are stale once memory has been replaced.
pub struct Cache {
    gpu: Rc<Gpu>,
    sets: BTreeMap<(usize, Vec<String>), (vk::DescriptorPool, Vec<vk::DescriptorSet>)>,
    framebuffers: BTreeMap<(vk::RenderPass, Vec<vk::ImageView>), vk::Framebuffer>,
}

impl Cache {
    pub fn new(gpu: &Rc<Gpu>) -> Self {
        Cache { gpu: gpu.clone(), sets: BTreeMap::new(), framebuffers: BTreeMap::new() }
    }

    /// Destroys everything. The device must not use it.
    pub fn clear(&mut self) {
        // SAFETY: the host has waited for all commands.
        unsafe {
            for (pool, _) in std::mem::take(&mut self.sets).into_values() {
                self.gpu.device.destroy_descriptor_pool(pool, None);
            }
            for framebuffer in std::mem::take(&mut self.framebuffers).into_values() {
                self.gpu.device.destroy_framebuffer(framebuffer, None);
            }
        }
    }

    /// Returns the descriptor sets of a pass, from 0 on. `names`: the resource that each binding of the pass means now.
    pub fn sets(
        &mut self,
        step: usize,
        shaders: &Shaders,
        names: Vec<String>,
        (memory, blocks): (&BTreeMap<String, Memory>, &Blocks),
    ) -> Result<Vec<vk::DescriptorSet>, Error> {
        if shaders.sets.is_empty() {
            return Ok(Vec::new());
        }
        if let Some((_, sets)) = self.sets.get(&(step, names.clone())) {
            return Ok(sets.clone());
        }
        let pool = self.pool(shaders)?;
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&shaders.sets);
        // SAFETY: the pool has room for these sets.
        let allocated = unsafe { self.gpu.device.allocate_descriptor_sets(&info) };
        // The cache owns the pool, also if it has no sets.
        let sets = allocated.as_ref().cloned().unwrap_or_default();
        self.sets.insert((step, names.clone()), (pool, sets.clone()));
        allocated.map_err(failed("descriptor sets"))?;
        for (binding, name) in shaders.bindings.iter().zip(&names) {
            let set = sets.get(binding.group as usize).copied().unwrap_or_default();
            let target = match (binding.kind, memory.get(name)) {
                (BindingKind::Uniform, _) => blocks.blocks.get(&binding.name).map(|(buffer, _)| Target::buffer(buffer)),
                (BindingKind::Texture, Some(Memory::Texture(texture))) => Some(Target::texture(texture, binding)),
                (_, Some(Memory::Buffer(buffer))) => Some(Target::buffer(buffer)),
                _ => None,
            };
            let target =
                target.ok_or_else(|| Error(format!("`{name}` is not what the binding `{}` needs", binding.name)))?;
            self.write(set, binding, &target);
        }
        Ok(sets)
    }

    fn pool(&self, shaders: &Shaders) -> Result<vk::DescriptorPool, Error> {
        let size = |kind| vk::DescriptorPoolSize::default().ty(descriptor_type(kind)).descriptor_count(1);
        let mut sizes: Vec<_> = shaders.bindings.iter().map(|binding| size(binding.kind)).collect();
        if sizes.is_empty() {
            sizes.push(size(BindingKind::Uniform));
        }
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(shaders.sets.len() as u32).pool_sizes(&sizes);
        // SAFETY: the device exists.
        unsafe { self.gpu.device.create_descriptor_pool(&info, None) }.map_err(failed("a descriptor pool"))
    }

    fn write(&self, set: vk::DescriptorSet, binding: &Binding, target: &Target) {
        let (buffers, images) = ([target.buffer], [target.image]);
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding.binding)
            .descriptor_type(descriptor_type(binding.kind));
        let write = match binding.kind {
            BindingKind::Texture => write.image_info(&images),
            _ => write.buffer_info(&buffers),
        };
        // SAFETY: no command uses the set yet, and it has such a binding.
        unsafe { self.gpu.device.update_descriptor_sets(&[write], &[]) };
    }

    /// Returns the framebuffer of a render pass with these attachments.
    pub fn framebuffer(
        &mut self,
        render_pass: vk::RenderPass,
        views: Vec<vk::ImageView>,
        [width, height]: [u32; 2],
    ) -> Result<vk::Framebuffer, Error> {
        let key = (render_pass, views);
        if let Some(framebuffer) = self.framebuffers.get(&key) {
            return Ok(*framebuffer);
        }
        let info = vk::FramebufferCreateInfo::default().render_pass(render_pass).attachments(&key.1);
        let info = info.width(width).height(height).layers(1);
        // SAFETY: the render pass and the views exist, and the views have this size.
        let framebuffer = unsafe { self.gpu.device.create_framebuffer(&info, None) };
        let framebuffer = framebuffer.map_err(failed("a framebuffer"))?;
        self.framebuffers.insert(key, framebuffer);
        Ok(framebuffer)
    }
}

impl Drop for Cache {
    fn drop(&mut self) {
        self.clear();
    }
}

/// What a descriptor refers to.
#[derive(Default)]
struct Target {
    buffer: vk::DescriptorBufferInfo,
    image: vk::DescriptorImageInfo,
}

impl Target {
    fn buffer(buffer: &Buffer) -> Self {
        let buffer = vk::DescriptorBufferInfo::default().buffer(buffer.buffer).range(buffer.bytes);
        Target { buffer, ..Target::default() }
    }

    fn texture(texture: &Texture, binding: &Binding) -> Self {
        let aspect = match binding.aspect.as_deref() {
            Some("depth-only") => vk::ImageAspectFlags::DEPTH,
            Some("stencil-only") => vk::ImageAspectFlags::STENCIL,
            _ => aspects(texture.format),
        };
        let image = vk::DescriptorImageInfo::default();
        let image = image.image_view(texture.view(aspect)).image_layout(sampled(texture.format).layout);
        Target { image, ..Target::default() }
    }
}

/// Returns the access of a fragment or compute shader that reads texels.
pub fn sampled(format: vk::Format) -> Access {
    let stages = vk::PipelineStageFlags::FRAGMENT_SHADER | vk::PipelineStageFlags::COMPUTE_SHADER;
    let layout = match is_depth(format) {
        true => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        false => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    };
    Access::new(stages, vk::AccessFlags::SHADER_READ, layout)
}
