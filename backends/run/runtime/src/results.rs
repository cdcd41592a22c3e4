//! What a frame has left: counters, times of passes, words of resources. Everything is read back by commands in the caller's
//! encoder, behind those of the frame.

use fragbuf_codegen::ResourceId;
use fragbuf_frame::COUNTERS_RESOURCE;

use crate::texture::read_texture;
use crate::{Counters, PassTime, Pending, Renderer};

impl Renderer {
    /// Records the readback of what the frame counted, over all slices. `None`: the plan counts nothing.
    pub fn counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Counters>> {
        self.counted(encoder, |words| Counters::sum(&words))
    }

    /// Records the readback of what each slice of the frame counted. `None`: the plan counts nothing.
    pub fn slice_counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<Counters>>> {
        self.counted(encoder, |words| Counters::each(&words))
    }

    fn counted<T>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        decode: impl FnOnce(Vec<u32>) -> T + Send + 'static,
    ) -> Option<Pending<T>> {
        let buffer = self.sized.tally.as_ref().or_else(|| self.buffer(COUNTERS_RESOURCE))?;
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), decode))
    }

    /// Records the readback of the time that each pass of the finished frame took. `None`: passes are not timed.
    pub fn pass_times(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<PassTime>>> {
        self.sized.timing.as_ref().map(|timing| timing.read(&self.device, encoder))
    }

    /// Records the readback of a resource, all its words: of a buffer those of the last slice; of a texture row after row,
    /// where only the last slice has left anything.
    /// `None`: the plan does not have it, it is empty, or it is a texture that cannot be copied, because it has several
    /// samples or a stencil, or was brought by the caller without the usage `COPY_SRC`.
    pub fn words(&self, resource: &str, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<u32>>> {
        if let Some(texture) = self.texture(resource) {
            return read_texture(&self.device, encoder, texture);
        }
        let buffer = self.buffer(resource)?;
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), |words| words))
    }

    /// The texture of a resource. `None`: the plan does not have it, it is a buffer, or the caller has not brought it.
    pub fn texture(&self, resource: &str) -> Option<&wgpu::Texture> {
        self.sized.memory.texture(self.physical(resource)?.0)
    }

    /// The buffer of a resource. `None`: the plan does not have it, or it is empty.
    pub fn buffer(&self, resource: &str) -> Option<&wgpu::Buffer> {
        self.sized.memory.filled(self.physical(resource)?.0)
    }

    /// What a resource stands for after the last frame.
    fn physical(&self, resource: &str) -> Option<ResourceId> {
        Some(self.plan().frame.physical(self.plan().resource_id(resource)?, self.flipped()))
    }
}
