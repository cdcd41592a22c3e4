//! The results of a frame: counters, times of passes, words of resources. The commands that read them back follow those of the
//! frame in the caller's encoder.

use fragbuf_codegen::ResourceId;
use fragbuf_frame::{COUNTERS_RESOURCE, LoopReport, loop_reports};

use crate::texture::read_texture;
use crate::{Counters, PassTime, Pending, Renderer};

impl Renderer {
    /// Records the readback of the frame's counters, over all slices. Returns `None` if the plan has no counters.
    pub fn counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Counters>> {
        self.read_counters(encoder, |words| Counters::sum(&words))
    }

    /// Records the readback of the counters of each slice. Returns `None` if the plan has no counters.
    pub fn slice_counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<Counters>>> {
        self.read_counters(encoder, |words| Counters::per_slice(&words))
    }

    fn read_counters<T>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        decode: impl FnOnce(Vec<u32>) -> T + Send + 'static,
    ) -> Option<Pending<T>> {
        let buffer = self.resources.slice_counters.as_ref().or_else(|| self.buffer(COUNTERS_RESOURCE))?;
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), decode))
    }

    /// Records the readback of the reports on the frame's loops. Returns `None` if the host ends them
    /// ([`Recorded::Finished`](crate::Recorded::Finished) has the reports then), and if no loop ends on a condition.
    pub fn loop_reports(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<LoopReport>>> {
        let (words, bytes) = self.conditional.as_ref()?.loop_words(self.plan());
        let pipelines = self.pipelines.clone();
        let decode = move |words: Vec<u32>| loop_reports(&pipelines.0.plan, &words);
        (bytes > 0).then(|| Pending::record(&self.device, encoder, words, 0, bytes, decode))
    }

    /// Records the readback of the time of each pass of the finished frame. Returns `None` if passes are not timed.
    pub fn pass_times(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<PassTime>>> {
        self.resources.timing.as_ref().map(|timing| timing.read(&self.device, encoder))
    }

    /// Records the readback of all words of a resource. A buffer has the words of the last slice. A texture is read row by row,
    /// and only the rows of the last slice are defined. Returns `None` if the plan has no such resource, if it is empty, or if
    /// it is a texture that cannot be copied: one with several samples or a stencil, or an external one without the usage
    /// `COPY_SRC`.
    pub fn words(&self, resource: &str, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<u32>>> {
        if let Some(texture) = self.texture(resource) {
            return read_texture(&self.device, encoder, texture);
        }
        let buffer = self.buffer(resource)?;
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), |words| words))
    }

    /// Returns the texture of a resource; `None` for an unknown name, a buffer, and an external texture that is not set.
    pub fn texture(&self, resource: &str) -> Option<&wgpu::Texture> {
        self.resources.memory.texture(self.physical(resource)?.0)
    }

    /// Returns the buffer of a resource; `None` for an unknown name and an empty resource.
    pub fn buffer(&self, resource: &str) -> Option<&wgpu::Buffer> {
        self.resources.memory.buffer(self.physical(resource)?.0)
    }

    /// Returns the physical resource of a name after the last frame.
    fn physical(&self, resource: &str) -> Option<ResourceId> {
        Some(self.plan().frame.physical(self.plan().resource_id(resource)?, self.flipped()))
    }
}
