//! Records commands into one command buffer, submits it, and waits where the host must read.

use std::rc::Rc;

use ash::vk;

use crate::Error;
use crate::access::{Access, Barrier};
use crate::context::failed;
use crate::gpu::Gpu;
use crate::memory::{Buffer, HostAccess, Memory, Texture, whole};
use crate::names::aspects;

/// The most steps of a frame in one command buffer: a loop may have a million iterations.
const MOST_STEPS: u32 = 4096;

/// A command buffer and the fence of its submission.
pub struct Recorder {
    gpu: Rc<Gpu>,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    is_recording: bool,
    /// The steps of the frame in the command buffer.
    steps: u32,
    staging: Option<Buffer>,
}

impl Recorder {
    pub fn new(gpu: &Rc<Gpu>) -> Result<Self, Error> {
        let (pool, commands, fence) = (vk::CommandPool::null(), vk::CommandBuffer::null(), vk::Fence::null());
        let mut recorder =
            Recorder { gpu: gpu.clone(), pool, commands, fence, is_recording: false, steps: 0, staging: None };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.family);
        // SAFETY: the family is that of the device's queue.
        unsafe {
            recorder.pool = gpu.device.create_command_pool(&info, None).map_err(failed("a command pool"))?;
            let info = vk::CommandBufferAllocateInfo::default().command_pool(recorder.pool).command_buffer_count(1);
            let allocated = gpu.device.allocate_command_buffers(&info).map_err(failed("a command buffer"))?;
            recorder.commands = allocated.first().copied().unwrap_or_default();
            recorder.fence = gpu.device.create_fence(&Default::default(), None).map_err(failed("a fence"))?;
        }
        Ok(recorder)
    }

    /// Returns the command buffer, which is recording.
    pub fn commands(&mut self) -> Result<vk::CommandBuffer, Error> {
        if !self.is_recording {
            let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            // SAFETY: the former commands have finished, because `finish` waits for them.
            unsafe {
                let reset = self.gpu.device.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty());
                reset.map_err(failed("the command pool"))?;
                self.gpu.device.begin_command_buffer(self.commands, &info).map_err(failed("the command buffer"))?;
            }
            self.is_recording = true;
            self.steps = 0;
        }
        Ok(self.commands)
    }

    /// Ends a step of the frame. Submits what has been recorded if it is long.
    pub fn end_step(&mut self) -> Result<(), Error> {
        self.steps += 1;
        if self.steps < MOST_STEPS { Ok(()) } else { self.finish() }
    }

    /// Forgets commands that have not been submitted.
    pub fn discard(&mut self) {
        self.is_recording = false;
    }

    /// Submits what has been recorded and waits for it.
    pub fn finish(&mut self) -> Result<(), Error> {
        if !std::mem::take(&mut self.is_recording) {
            return Ok(());
        }
        let (device, commands) = (&self.gpu.device, [self.commands]);
        let submits = [vk::SubmitInfo::default().command_buffers(&commands)];
        // SAFETY: the command buffer is recording, and the fence is unsignalled.
        unsafe {
            device.end_command_buffer(self.commands).map_err(failed("the command buffer"))?;
            device.queue_submit(self.gpu.queue, &submits, self.fence).map_err(failed("a submission"))?;
            device.wait_for_fences(&[self.fence], true, u64::MAX).map_err(failed("the end of a submission"))?;
            device.reset_fences(&[self.fence]).map_err(failed("a fence"))
        }
    }

    /// Records barriers before the next use of memory, each with the image if it is a texture.
    pub fn barriers(&mut self, barriers: &[(Barrier, Option<&Texture>)]) -> Result<(), Error> {
        let (mut before, mut after) = (vk::PipelineStageFlags::empty(), vk::PipelineStageFlags::empty());
        let (mut images, mut memory) = (Vec::new(), vk::MemoryBarrier::default());
        for (barrier, texture) in barriers {
            before |= barrier.before.stages;
            after |= barrier.after.stages;
            match texture {
                None => {
                    memory.src_access_mask |= barrier.before.access;
                    memory.dst_access_mask |= barrier.after.access;
                }
                Some(texture) => images.push(
                    vk::ImageMemoryBarrier::default()
                        .src_access_mask(barrier.before.access)
                        .dst_access_mask(barrier.after.access)
                        .old_layout(barrier.before.layout)
                        .new_layout(barrier.after.layout)
                        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                        .image(texture.image)
                        .subresource_range(whole(aspects(texture.format))),
                ),
            }
        }
        if barriers.is_empty() {
            return Ok(());
        }
        if before.is_empty() {
            before = vk::PipelineStageFlags::TOP_OF_PIPE;
        }
        let (commands, none) = (self.commands()?, vk::DependencyFlags::empty());
        // SAFETY: the command buffer is recording outside of a render pass.
        unsafe { self.gpu.device.cmd_pipeline_barrier(commands, before, after, none, &[memory], &[], &images) };
        Ok(())
    }

    /// Records the barrier before a use of memory.
    pub fn transition(&mut self, memory: &mut Memory, next: Access) -> Result<(), Error> {
        let is_texture = matches!(memory, Memory::Texture(_));
        let state = match memory {
            Memory::Buffer(buffer) => &mut buffer.state,
            Memory::Texture(texture) => &mut texture.state,
        };
        let Some(barrier) = state.change(next, is_texture) else { return Ok(()) };
        let texture = match memory {
            Memory::Texture(texture) => Some(&*texture),
            Memory::Buffer(_) => None,
        };
        self.barriers(&[(barrier, texture)])
    }

    /// Waits for the device, and returns bytes that `copy` copies into a buffer.
    pub fn read(
        &mut self,
        bytes: u64,
        copy: impl FnOnce(&ash::Device, vk::CommandBuffer, vk::Buffer),
    ) -> Result<Vec<u8>, Error> {
        if self.staging.as_ref().is_none_or(|staging| staging.bytes < bytes) {
            // The former buffer may be in use.
            self.finish()?;
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            self.staging = Some(Buffer::new(&self.gpu, "words for the host", bytes, usage, HostAccess::Read)?);
        }
        let commands = self.commands()?;
        let Some(staging) = &mut self.staging else { return Ok(Vec::new()) };
        let (first, second) =
            (staging.state.change(Access::COPY_TARGET, false), staging.state.change(Access::HOST, false));
        let target = staging.buffer;
        self.barriers(&first.into_iter().map(|barrier| (barrier, None)).collect::<Vec<_>>())?;
        copy(&self.gpu.device, commands, target);
        self.barriers(&second.into_iter().map(|barrier| (barrier, None)).collect::<Vec<_>>())?;
        self.finish()?;
        Ok(self.staging.as_ref().map(|staging| staging.read(bytes)).unwrap_or_default())
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        // SAFETY: `finish` has waited for all commands.
        unsafe {
            self.gpu.device.destroy_fence(self.fence, None);
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}
