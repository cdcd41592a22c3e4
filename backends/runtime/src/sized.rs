//! Everything that depends on the size of the frame: buffers, bind groups, and the attachment of passes without a target.
//! It is made whole and replaced as one, so that a failure leaves the old one standing.

use fragbuf_codegen::Plan;

use crate::Error;
use crate::blocks::Blocks;
use crate::layout::Slot;
use crate::memory::Memory;
use crate::pipeline::DUMMY_FORMAT;
use crate::renderer::Prepared;
use crate::scope::scoped;
use crate::symbols::Symbols;

/// Everything that depends on the size of the frame, replaced as one.
pub(crate) struct Sized {
    pub(crate) symbols: Symbols,
    pub(crate) memory: Memory,
    pub(crate) groups: Vec<wgpu::BindGroup>,
    /// The attachment of passes without a target.
    pub(crate) dummy: wgpu::TextureView,
}

impl Sized {
    pub(crate) async fn new(
        device: &wgpu::Device,
        plan: &Plan,
        passes: &[Prepared],
        blocks: &Blocks,
        symbols: Symbols,
        old: Option<&Sized>,
    ) -> Result<Self, Error> {
        check_size(device, &symbols)?;
        let memory = Memory::allocate(device, plan, &symbols, old.map(|old| &old.memory)).await?;
        let groups = || passes.iter().map(|prepared| bind_group(device, prepared, blocks, &memory)).collect();
        let groups = scoped(device, "the bind groups", 0, groups).await?;
        let same = old.filter(|old| (old.symbols.width, old.symbols.height) == (symbols.width, symbols.height));
        let dummy = match same {
            Some(old) => old.dummy.clone(),
            None => {
                scoped(device, "the attachment of geometry passes", symbols.pixels(), || dummy(device, &symbols))
                    .await?
            }
        };
        Ok(Sized { symbols, memory, groups, dummy })
    }
}

/// What passes without a target are attached to. Nothing is ever written to it, and tilers give it no memory.
fn dummy(device: &wgpu::Device, symbols: &Symbols) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("fragbuf no target"),
        size: wgpu::Extent3d { width: symbols.width, height: symbols.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
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

fn bind_group(device: &wgpu::Device, prepared: &Prepared, blocks: &Blocks, memory: &Memory) -> wgpu::BindGroup {
    let buffer = |slot: &Slot| match *slot {
        Slot::Filler => &blocks.filler,
        Slot::Frame => &blocks.frame,
        Slot::Uniforms => &blocks.own,
        Slot::Camera => &blocks.camera,
        Slot::Resource { index, .. } => memory.buffer(index).unwrap_or(&blocks.filler),
    };
    let slots = (0..).zip(&prepared.slots);
    let entries: Vec<wgpu::BindGroupEntry<'_>> = slots
        .map(|(binding, slot)| wgpu::BindGroupEntry { binding, resource: buffer(slot).as_entire_binding() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(&prepared.pass.anchor),
        layout: &prepared.layout,
        entries: &entries,
    })
}
