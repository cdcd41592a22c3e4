//! Everything that depends on the size of the frame: its slices, buffers, bind groups, queries, and placeholder attachments.
//! A new value is built completely before it replaces the old one, so a failure leaves the old one in use.

use fragbuf_frame::{COUNTERS_RESOURCE, MemoryLimits, Values};

use crate::Error;
use crate::bind_groups::{BindGroupSources, bind_groups, combination};
use crate::error_scope::in_error_scope;
use crate::frame_blocks::FrameBlocks;
use crate::memory::Memory;
use crate::pipelines::{PipelineSet, PreparedPass};
use crate::placeholder::PlaceholderAttachment;
use crate::timing::Timing;
use crate::uniform_buffers::UniformBuffers;

/// Everything that depends on the size of the frame, replaced as one.
pub(crate) struct FrameResources {
    pub(crate) values: Values,
    pub(crate) memory: Memory,
    /// The shaders' `frame` of every slice and iteration.
    pub(crate) frame_blocks: FrameBlocks,
    /// The bind groups of every pass, one for each combination of flipped exchanges that it uses.
    pub(crate) groups: Vec<Vec<wgpu::BindGroup>>,
    pub(crate) placeholders: Vec<PlaceholderAttachment>,
    pub(crate) timing: Option<Timing>,
    /// The counters of every slice, one after the other; `None` for a frame of one slice, or a plan without counters.
    pub(crate) slice_counters: Option<wgpu::Buffer>,
}

/// The device objects that do not depend on the size.
pub(crate) struct DeviceObjects<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) pipelines: &'a PipelineSet,
    pub(crate) uniforms: &'a UniformBuffers,
    pub(crate) timestamps: Timestamps,
    pub(crate) limits: MemoryLimits,
}

/// Whether passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Timestamps {
    Enabled,
    Disabled,
}

impl FrameResources {
    /// Creates the resources for `values`, which include the height of a slice. Objects of the right size come from `old`.
    pub(crate) async fn new(
        objects: &DeviceObjects<'_>,
        values: Values,
        old: Option<&FrameResources>,
    ) -> Result<Self, Error> {
        let DeviceObjects { device, queue, pipelines, timestamps, limits, .. } = objects;
        check_size(device, &values)?;
        let old_memory = old.map(|old| &old.memory);
        let memory = Memory::allocate(device, (&pipelines.plan, limits), &values, old_memory).await?;
        let frame_blocks = FrameBlocks::new(device, pipelines, values.slices()).await?;
        let make = || bind_groups(&sources(objects, &frame_blocks, &memory));
        let groups = in_error_scope(device, "the bind groups", 0, make).await?;
        let size = |values: &Values| (values.width(), values.height());
        let placeholders = match old.filter(|old| size(&old.values) == size(&values)) {
            Some(old) => old.placeholders.clone(),
            None => PlaceholderAttachment::for_plan(device, &pipelines.plan, &values).await?,
        };
        // Counters and times of earlier slices of a suspended frame must survive.
        let same = old.filter(|old| old.values.slices() == values.slices());
        let runs = pipelines.max_pass_runs.saturating_mul(values.slices().into());
        let timing = match (timestamps, same.and_then(|old| old.timing.as_ref())) {
            (Timestamps::Disabled, _) => None,
            (Timestamps::Enabled, Some(old)) if old.is_for(runs) => Some(old.clone()),
            (Timestamps::Enabled, _) => {
                let passes = pipelines.plan.passes.iter().map(|pass| pass.name.clone()).collect();
                Some(Timing::new(device, queue, passes, runs).await?)
            }
        };
        let slice_counters = match same {
            Some(old) => old.slice_counters.clone(),
            None => slice_counters(device, pipelines, &memory, values.slices()).await?,
        };
        Ok(FrameResources { values, memory, frame_blocks, groups, placeholders, timing, slice_counters })
    }

    /// Creates the bind groups for other memory.
    pub(crate) fn bind_groups(&self, objects: &DeviceObjects<'_>, memory: &Memory) -> Vec<Vec<wgpu::BindGroup>> {
        bind_groups(&sources(objects, &self.frame_blocks, memory))
    }

    /// Returns the bind group of a pass where the exchanges of the bit mask `flipped` are flipped.
    pub(crate) fn group(&self, pass: usize, prepared: &PreparedPass, flipped: u32) -> Option<&wgpu::BindGroup> {
        self.groups.get(pass)?.get(combination(prepared, flipped))
    }
}

fn sources<'a>(objects: &DeviceObjects<'a>, frame_blocks: &'a FrameBlocks, memory: &'a Memory) -> BindGroupSources<'a> {
    let DeviceObjects { device, pipelines, uniforms, .. } = *objects;
    BindGroupSources { device, pipelines, uniforms, frame_blocks, memory }
}

/// Creates the buffer for the counters of every slice.
async fn slice_counters(
    device: &wgpu::Device,
    pipelines: &PipelineSet,
    memory: &Memory,
    slices: u32,
) -> Result<Option<wgpu::Buffer>, Error> {
    let counters = pipelines.plan.resource_id(COUNTERS_RESOURCE).and_then(|id| memory.buffer(id.0));
    let Some(counters) = counters.filter(|_| slices > 1) else { return Ok(None) };
    let descriptor = wgpu::BufferDescriptor {
        label: Some("fragbuf counters of all slices"),
        size: u64::from(slices) * counters.size(),
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    let make = || device.create_buffer(&descriptor);
    in_error_scope(device, "the counters of all slices", descriptor.size, make).await.map(Some)
}

fn check_size(device: &wgpu::Device, values: &Values) -> Result<(), Error> {
    let limit = device.limits().max_texture_dimension_2d;
    for (what, size) in [("the frame's width", values.width()), ("the frame's height", values.height())] {
        if size == 0 {
            return Err(Error::BadValue { name: what.to_owned(), expected: "at least 1".to_owned() });
        }
        if size > limit {
            return Err(Error::TooLarge {
                what: what.to_owned(),
                needed: size.into(),
                limit: limit.into(),
                limit_name: "max_texture_dimension_2d",
                help: "render the image in tiles",
                shrinks_with_rows: false,
            });
        }
    }
    Ok(())
}
