//! Everything that depends on the size of the frame: its slices, buffers, bind groups, queries, and the attachment of
//! passes without a target.
//! It is made whole and replaced as one, so that a failure leaves the old one standing.

use fragbuf_codegen::{Plan, PlannedPass, ResourceId};
use fragbuf_frame::{COUNTERS_RESOURCE, Values};

use crate::Error;
use crate::blocks::Blocks;
use crate::fixed_function::sample_count;
use crate::layout::Slot;
use crate::memory::Memory;
use crate::pipeline::DUMMY_FORMAT;
use crate::pipelines::{Made, Prepared};
use crate::scope::scoped;
use crate::texture::sampled_view;
use crate::timing::Timing;
use crate::words::to_bytes;

/// Everything that depends on the size of the frame, replaced as one.
pub(crate) struct Sized {
    pub(crate) values: Values,
    pub(crate) memory: Memory,
    /// The shaders' `frame` of every slice and iteration.
    pub(crate) frames: Frames,
    /// The bind groups of every pass, one for each way to flip the exchanges that it uses.
    pub(crate) groups: Vec<Vec<wgpu::BindGroup>>,
    /// The attachments of passes without a target.
    dummies: Vec<Dummy>,
    pub(crate) timing: Option<Timing>,
    /// The counters of every slice, one after the other; `None` where one slice is the frame, or nothing counts.
    pub(crate) tally: Option<wgpu::Buffer>,
}

/// An attachment of passes without a target.
#[derive(Clone)]
struct Dummy {
    /// Per pixel.
    samples: u32,
    view: wgpu::TextureView,
}

/// The uniform block `frame`, once for every iteration of every slice, in one buffer.
#[derive(Clone)]
pub(crate) struct Frames {
    pub(crate) buffer: wgpu::Buffer,
    /// Bytes of the block.
    size: u64,
    /// Bytes from one to the next.
    stride: u64,
    iterations: u32,
}

/// What does not change with the size.
pub(crate) struct Fixed<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) made: &'a Made,
    pub(crate) blocks: &'a Blocks,
    pub(crate) timed: Timed,
}

/// Whether passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Timed {
    Yes,
    No,
}

impl Sized {
    /// For `values`, whose slices have their height already. What has the right size is taken over from `old`.
    pub(crate) async fn new(fixed: &Fixed<'_>, values: Values, old: Option<&Sized>) -> Result<Self, Error> {
        let Fixed { device, queue, made, timed, .. } = fixed;
        check_size(device, &values)?;
        let memory = Memory::allocate(device, &made.plan, &values, old.map(|old| &old.memory)).await?;
        let frames = Frames::new(device, made, values.slices()).await?;
        let groups = scoped(device, "the bind groups", 0, || bind_groups(fixed, &frames, &memory)).await?;
        let size = |values: &Values| (values.width(), values.height());
        let dummies = match old.filter(|old| size(&old.values) == size(&values)) {
            Some(old) => old.dummies.clone(),
            None => dummies(device, made, &values).await?,
        };
        // What earlier slices of a frame that was cut have counted and taken must not be lost.
        let same = old.filter(|old| old.values.slices() == values.slices());
        let runs = made.most_runs.saturating_mul(values.slices().into());
        let timing = match (timed, same.and_then(|old| old.timing.as_ref())) {
            (Timed::No, _) => None,
            (Timed::Yes, Some(old)) if old.is_for(runs) => Some(old.clone()),
            (Timed::Yes, _) => {
                let passes = made.plan.passes.iter().map(|pass| pass.anchor.clone()).collect();
                Some(Timing::new(device, queue, passes, runs).await?)
            }
        };
        let tally = match same {
            Some(old) => old.tally.clone(),
            None => tally(device, made, &memory, values.slices()).await?,
        };
        Ok(Sized { values, memory, frames, groups, dummies, timing, tally })
    }

    /// What a pass of the plan is attached to that has no target.
    pub(crate) fn dummy(&self, plan: &Plan, pass: &PlannedPass) -> Option<wgpu::TextureView> {
        let samples = sample_count(plan, pass).ok()?;
        self.dummies.iter().find(|dummy| dummy.samples == samples).map(|dummy| dummy.view.clone())
    }

    /// The bind groups once more, for other memory.
    pub(crate) fn bound(&self, fixed: &Fixed<'_>, memory: &Memory) -> Vec<Vec<wgpu::BindGroup>> {
        bind_groups(fixed, &self.frames, memory)
    }

    /// The bind group of a pass where these exchanges are flipped.
    pub(crate) fn group(&self, pass: usize, prepared: &Prepared, flipped: u32) -> Option<&wgpu::BindGroup> {
        let bit = |(bit, number): (usize, &usize)| (flipped >> number & 1) << bit;
        let way: u32 = prepared.exchanges.iter().enumerate().map(bit).sum();
        self.groups.get(pass)?.get(way as usize)
    }
}

impl Frames {
    async fn new(device: &wgpu::Device, made: &Made, slices: u32) -> Result<Self, Error> {
        let size = (4 * made.plan.fields.len() as u64).next_multiple_of(16);
        let stride = size.next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment).max(16));
        let descriptor = wgpu::BufferDescriptor {
            label: Some("fragbuf frame"),
            size: stride * u64::from(slices) * u64::from(made.iterations),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let make = || device.create_buffer(&descriptor);
        let buffer = scoped(device, "the uniform blocks of the frame", descriptor.size, make).await?;
        Ok(Frames { buffer, size, stride, iterations: made.iterations })
    }

    /// The dynamic offset of the block of an iteration of a slice.
    pub(crate) fn offset(&self, slice: u32, iteration: u32) -> u32 {
        let block = u64::from(slice) * u64::from(self.iterations) + u64::from(iteration.min(self.iterations - 1));
        u32::try_from(block * self.stride).unwrap_or(u32::MAX)
    }

    /// The bytes of all blocks, by what the words of one are.
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
                if let Some(place) = bytes.get_mut(at..at + block.len()) {
                    place.copy_from_slice(&block);
                }
            }
        }
        Ok(bytes)
    }
}

fn bind_groups(fixed: &Fixed<'_>, frames: &Frames, memory: &Memory) -> Vec<Vec<wgpu::BindGroup>> {
    let groups = |prepared: &Prepared| {
        let ways = 0..1u32 << prepared.exchanges.len();
        let flipped = |way: u32| {
            let bit = |(bit, number): (usize, &usize)| (way >> bit & 1) << number;
            prepared.exchanges.iter().enumerate().map(bit).sum::<u32>()
        };
        ways.map(|way| bind_group(fixed, prepared, (frames, memory), flipped(way))).collect()
    };
    fixed.made.passes.iter().map(groups).collect()
}

/// Room for the counters of every slice.
async fn tally(
    device: &wgpu::Device,
    made: &Made,
    memory: &Memory,
    slices: u32,
) -> Result<Option<wgpu::Buffer>, Error> {
    let counters = made.plan.resource_id(COUNTERS_RESOURCE).and_then(|id| memory.filled(id.0));
    let Some(counters) = counters.filter(|_| slices > 1) else { return Ok(None) };
    let descriptor = wgpu::BufferDescriptor {
        label: Some("fragbuf counters of all slices"),
        size: u64::from(slices) * counters.size(),
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    let make = || device.create_buffer(&descriptor);
    scoped(device, "the counters of all slices", descriptor.size, make).await.map(Some)
}

/// One attachment for every number of samples that a pass of the plan has.
async fn dummies(device: &wgpu::Device, made: &Made, values: &Values) -> Result<Vec<Dummy>, Error> {
    let mut dummies: Vec<Dummy> = Vec::new();
    for prepared in &made.passes {
        let samples = sample_count(&made.plan, &prepared.pass)?;
        if dummies.iter().all(|dummy| dummy.samples != samples) {
            let bytes = u64::from(samples) * u64::from(values.width()) * u64::from(values.height());
            let make = || dummy(device, values, samples);
            let view = scoped(device, "the attachment of geometry passes", bytes, make).await?;
            dummies.push(Dummy { samples, view });
        }
    }
    Ok(dummies)
}

/// What passes without a target are attached to. Nothing is ever written to it, and tilers give it no memory.
fn dummy(device: &wgpu::Device, values: &Values, samples: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("fragbuf no target"),
        size: wgpu::Extent3d { width: values.width(), height: values.height(), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format: DUMMY_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TRANSIENT_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn check_size(device: &wgpu::Device, values: &Values) -> Result<(), Error> {
    let limit = device.limits().max_texture_dimension_2d;
    for (what, size) in [("the frame's width", values.width()), ("the frame's height", values.height())] {
        if size == 0 {
            return Err(Error::BadValue { name: what.to_owned(), wanted: "at least 1".to_owned() });
        }
        if size > limit {
            return Err(Error::TooLarge {
                what: what.to_owned(),
                needed: size.into(),
                limit: limit.into(),
                limit_name: "max_texture_dimension_2d",
                hint: "render the picture in tiles",
            });
        }
    }
    Ok(())
}

fn bind_group(
    fixed: &Fixed<'_>,
    prepared: &Prepared,
    (frames, memory): (&Frames, &Memory),
    flipped: u32,
) -> wgpu::BindGroup {
    let Fixed { device, made, blocks, .. } = fixed;
    let physical = |index: usize| made.plan.frame.physical(ResourceId(index), flipped).0;
    let view = |slot: &Slot| match *slot {
        Slot::Texture { index, .. } => memory.bound_texture(physical(index)).map(sampled_view),
        _ => None,
    };
    let views: Vec<Option<wgpu::TextureView>> = prepared.slots.iter().map(view).collect();
    let buffer = |slot: &Slot| match *slot {
        Slot::Filler | Slot::Texture { .. } => &blocks.filler,
        Slot::Frame => &frames.buffer,
        Slot::Uniforms => &blocks.own,
        Slot::Camera => &blocks.camera,
        Slot::Resource { index, .. } => memory.buffer(physical(index)).unwrap_or(&blocks.filler),
    };
    let slots = (0..).zip(prepared.slots.iter().zip(&views));
    let entries: Vec<wgpu::BindGroupEntry<'_>> = slots
        .map(|(binding, (slot, view))| {
            let size = (*slot == Slot::Frame).then(|| wgpu::BufferSize::new(frames.size)).flatten();
            let buffer =
                || wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: buffer(slot), offset: 0, size });
            let resource = view.as_ref().map_or_else(buffer, wgpu::BindingResource::TextureView);
            wgpu::BindGroupEntry { binding, resource }
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(&prepared.pass.anchor),
        layout: &prepared.layout,
        entries: &entries,
    })
}
