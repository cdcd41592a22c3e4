//! The memory limits of a renderer: those of its device, and the caller's budget.
//!
//! The image is the caller's, so its memory is not part of the budget.

use fragbuf_frame::{BufferLimit, MemoryLimits};

use crate::Error;
use crate::frame_blocks::block_stride;
use crate::pipelines::PipelineSet;
use crate::placeholder::bytes_per_pixel;

/// Returns the limits for frames of a plan; `budget` is that of the settings, in bytes.
pub(crate) fn memory_limits(
    device: &wgpu::Device,
    pipelines: &PipelineSet,
    budget: u64,
) -> Result<MemoryLimits, Error> {
    let limits = device.limits();
    let binding = (limits.max_storage_buffer_binding_size, "max_storage_buffer_binding_size, in bytes");
    let buffer = (limits.max_buffer_size, "max_buffer_size, in bytes");
    let (bytes, name) = if binding.0 <= buffer.0 { binding } else { buffer };
    let help = "use a smaller frame or lower slices, keep fewer fragments, reserve less, or request a device with the adapter's own limits";
    // A block exists on the device, and on the host while it is written.
    let blocks = 2 * block_stride(device, &pipelines.plan).saturating_mul(pipelines.max_iterations.into());
    Ok(MemoryLimits {
        budget,
        buffer: BufferLimit { bytes, name, help },
        copies_external: false,
        per_pixel: bytes_per_pixel(&pipelines.plan)?,
        per_slice_pixel: 0,
        per_slice: blocks,
    })
}
