//! The uniform blocks `frame`: one per slice and loop iteration, in one buffer with dynamic offsets.

use fragbuf_codegen::Plan;

use crate::Error;
use crate::error_scope::in_error_scope;
use crate::pipelines::PipelineSet;
use crate::words::to_bytes;

/// The buffer of the uniform blocks.
#[derive(Clone)]
pub(crate) struct FrameBlocks {
    pub(crate) buffer: wgpu::Buffer,
    /// The bytes of a block.
    pub(crate) size: u64,
    /// The bytes from one block to the next.
    stride: u64,
    iterations: u32,
}

/// Returns the bytes of a block.
fn block_size(plan: &Plan) -> u64 {
    (4 * plan.fields.len() as u64).next_multiple_of(16)
}

/// Returns the bytes from one block to the next.
pub(crate) fn block_stride(device: &wgpu::Device, plan: &Plan) -> u64 {
    block_size(plan).next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment).max(16))
}

impl FrameBlocks {
    pub(crate) async fn new(device: &wgpu::Device, pipelines: &PipelineSet, slices: u32) -> Result<Self, Error> {
        let (size, stride) = (block_size(&pipelines.plan), block_stride(device, &pipelines.plan));
        let blocks = u64::from(slices) * u64::from(pipelines.max_iterations);
        let bytes = stride.saturating_mul(blocks);
        // Dynamic offsets have 32 bits.
        let limit = device.limits().max_buffer_size.min(u32::MAX.into());
        if bytes > limit {
            return Err(Error::TooLarge {
                what: format!("the uniform blocks of {slices} slices"),
                needed: bytes,
                limit,
                limit_name: "max_buffer_size and offsets of 32 bits, in bytes",
                help: "use a smaller frame, higher slices or fewer iterations",
                shrinks_with_rows: false,
            });
        }
        let descriptor = wgpu::BufferDescriptor {
            label: Some("fragbuf frame"),
            size: bytes,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let make = || device.create_buffer(&descriptor);
        let buffer = in_error_scope(device, "the uniform blocks of the frame", descriptor.size, make).await?;
        Ok(FrameBlocks { buffer, size, stride, iterations: pipelines.max_iterations })
    }

    /// Returns the dynamic offset of the block of an iteration of a slice.
    pub(crate) fn offset(&self, slice: u32, iteration: u32) -> u32 {
        let block = u64::from(slice) * u64::from(self.iterations) + u64::from(iteration.min(self.iterations - 1));
        u32::try_from(block * self.stride).unwrap_or(u32::MAX)
    }

    /// Returns the bytes of all blocks. `words` returns the words of the block of a slice and an iteration.
    pub(crate) fn bytes(
        &self,
        slices: u32,
        words: &dyn Fn(u32, u32) -> Result<Vec<u32>, Error>,
    ) -> Result<Vec<u8>, Error> {
        let mut bytes = vec![0; self.buffer.size() as usize];
        for slice in 0..slices {
            for iteration in 0..self.iterations {
                let block = to_bytes(&words(slice, iteration)?);
                let at = self.offset(slice, iteration) as usize;
                if let Some(destination) = bytes.get_mut(at..at + block.len()) {
                    destination.copy_from_slice(&block);
                }
            }
        }
        Ok(bytes)
    }
}
