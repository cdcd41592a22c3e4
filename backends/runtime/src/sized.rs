//! Everything that depends on the size of the frame: its slices, buffers, bind groups, queries, and the attachment of
//! passes without a target.
//! It is made whole and replaced as one, so that a failure leaves the old one standing.

use fragbuf_codegen::Plan;
use fragbuf_frame::{COUNTERS_RESOURCE, Symbols, resource as index};
use fragbuf_templates::vocabulary::Pass;

use crate::Error;
use crate::blocks::{Blocks, block};
use crate::fixed_function::sample_count;
use crate::layout::Slot;
use crate::memory::Memory;
use crate::pipeline::DUMMY_FORMAT;
use crate::pipelines::{Made, Prepared};
use crate::scope::scoped;
use crate::texture::sampled_view;
use crate::timing::Timing;

/// Everything that depends on the size of the frame, replaced as one.
pub(crate) struct Sized {
    pub(crate) symbols: Symbols,
    pub(crate) memory: Memory,
    /// By slice and round.
    pub(crate) slices: Vec<Vec<Round>>,
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

/// What passes see in one round of a slice.
pub(crate) struct Round {
    /// The uniform buffer with the slice's first row and the round's number.
    pub(crate) frame: wgpu::Buffer,
    /// One bind group per pass.
    pub(crate) groups: Vec<wgpu::BindGroup>,
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
    /// For `symbols`, whose slices have their height already. What has the right size is taken over from `old`.
    pub(crate) async fn new(fixed: &Fixed<'_>, symbols: Symbols, old: Option<&Sized>) -> Result<Self, Error> {
        let Fixed { device, queue, made, timed, .. } = fixed;
        check_size(device, &symbols)?;
        let memory = Memory::allocate(device, &made.plan, &symbols, old.map(|old| &old.memory)).await?;
        let round = || {
            let frame = block(device, "fragbuf frame", made.plan.frame.len());
            Round { groups: bind_groups(fixed, &frame, &memory), frame }
        };
        let rounds = made.actions.rounds;
        let slices = || (0..symbols.slices()).map(|_| (0..rounds).map(|_| round()).collect()).collect();
        let slices = scoped(device, "the bind groups", 0, slices).await?;
        let same = old.filter(|old| (old.symbols.width, old.symbols.height) == (symbols.width, symbols.height));
        let dummies = match same {
            Some(old) => old.dummies.clone(),
            None => dummies(device, made, &symbols).await?,
        };
        // What earlier slices of a frame that was cut have counted and taken must not be lost.
        let same = old.filter(|old| old.symbols.slices() == symbols.slices());
        let (timing, tally) = match same {
            Some(old) => (old.timing.clone(), old.tally.clone()),
            None => {
                let timing = match timed {
                    Timed::Yes => Some(Timing::new(device, queue, made.run_names(), symbols.slices()).await?),
                    Timed::No => None,
                };
                (timing, tally(device, made, &memory, symbols.slices()).await?)
            }
        };
        Ok(Sized { symbols, memory, slices, dummies, timing, tally })
    }

    /// What a pass of the plan is attached to that has no target.
    pub(crate) fn dummy(&self, plan: &Plan, pass: &Pass) -> Option<wgpu::TextureView> {
        let samples = sample_count(plan, pass).ok()?;
        self.dummies.iter().find(|dummy| dummy.samples == samples).map(|dummy| dummy.view.clone())
    }

    /// The bind groups once more, by slice and round, for other memory.
    pub(crate) fn bound(&self, fixed: &Fixed<'_>, memory: &Memory) -> Vec<Vec<Vec<wgpu::BindGroup>>> {
        let rounds = self.slices.iter().map(|rounds| rounds.iter());
        rounds.map(|rounds| rounds.map(|round| bind_groups(fixed, &round.frame, memory)).collect()).collect()
    }
}

fn bind_groups(fixed: &Fixed<'_>, frame: &wgpu::Buffer, memory: &Memory) -> Vec<wgpu::BindGroup> {
    let group = |prepared| bind_group(fixed.device, prepared, frame, fixed.blocks, memory);
    fixed.made.passes.iter().map(group).collect()
}

/// Room for the counters of every slice.
async fn tally(
    device: &wgpu::Device,
    made: &Made,
    memory: &Memory,
    slices: u32,
) -> Result<Option<wgpu::Buffer>, Error> {
    let counters = index(&made.plan, COUNTERS_RESOURCE).ok().and_then(|index| memory.filled(index));
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
async fn dummies(device: &wgpu::Device, made: &Made, symbols: &Symbols) -> Result<Vec<Dummy>, Error> {
    let mut dummies: Vec<Dummy> = Vec::new();
    for prepared in &made.passes {
        let samples = sample_count(&made.plan, &prepared.pass)?;
        if dummies.iter().all(|dummy| dummy.samples != samples) {
            let bytes = u64::from(samples) * u64::from(symbols.width) * u64::from(symbols.height);
            let make = || dummy(device, symbols, samples);
            let view = scoped(device, "the attachment of geometry passes", bytes, make).await?;
            dummies.push(Dummy { samples, view });
        }
    }
    Ok(dummies)
}

/// What passes without a target are attached to. Nothing is ever written to it, and tilers give it no memory.
fn dummy(device: &wgpu::Device, symbols: &Symbols, samples: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("fragbuf no target"),
        size: wgpu::Extent3d { width: symbols.width, height: symbols.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format: DUMMY_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TRANSIENT_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn check_size(device: &wgpu::Device, symbols: &Symbols) -> Result<(), Error> {
    let limit = device.limits().max_texture_dimension_2d;
    for (what, size) in [("the frame's width", symbols.width), ("the frame's height", symbols.height)] {
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
    device: &wgpu::Device,
    prepared: &Prepared,
    frame: &wgpu::Buffer,
    blocks: &Blocks,
    memory: &Memory,
) -> wgpu::BindGroup {
    let view = |slot: &Slot| match *slot {
        Slot::Texture { index, .. } => memory.bound_texture(index).map(sampled_view),
        _ => None,
    };
    let views: Vec<Option<wgpu::TextureView>> = prepared.slots.iter().map(view).collect();
    let buffer = |slot: &Slot| match *slot {
        Slot::Filler | Slot::Texture { .. } => &blocks.filler,
        Slot::Frame => frame,
        Slot::Uniforms => &blocks.own,
        Slot::Camera => &blocks.camera,
        Slot::Resource { index, .. } => memory.buffer(index).unwrap_or(&blocks.filler),
    };
    let slots = (0..).zip(prepared.slots.iter().zip(&views));
    let entries: Vec<wgpu::BindGroupEntry<'_>> = slots
        .map(|(binding, (slot, view))| {
            let buffer = || buffer(slot).as_entire_binding();
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
