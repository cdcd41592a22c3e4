//! Bind group layouts: what each pass touches, at the plan's own bindings.
//!
//! Layouts are dense: a binding that a pass does not touch is there, visible to no stage. wgpu's Vulkan back end numbers
//! the bindings of a layout anew, one after the other; it rewrites WGSL to match, but SPIR-V that is passed through keeps
//! the plan's numbers, and only in a dense layout are both the same.

use fragbuf_codegen::{FIRST_BINDING, Plan};
use fragbuf_frame::Values;
use fragbuf_templates::vocabulary::{Access, Element, Extent, Kind, Pass};

use crate::Error;
use crate::texture::{SAMPLE, sample_type};

/// Bindings of the description's uniforms and of the camera; the frame's is 0.
const UNIFORMS: usize = 1;
const CAMERA: usize = 2;

/// What stands at one binding of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    /// Nothing that the pass touches.
    Filler,
    /// The frame's block; which slice's and iteration's is a dynamic offset.
    Frame,
    Uniforms,
    Camera,
    /// The resource of this number.
    Resource {
        index: usize,
        read_only: bool,
    },
    /// The texture of the resource of this number.
    Texture {
        index: usize,
        sample_type: wgpu::TextureSampleType,
        samples: Samples,
    },
}

/// Whether a texture has several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Samples {
    One,
    Several,
}

/// The slots of a pass, by binding.
pub(crate) fn slots(plan: &Plan, pass: &Pass) -> Vec<Slot> {
    let mut slots = vec![Slot::Frame, Slot::Filler, Slot::Filler];
    if !plan.variant.uniforms.is_empty() {
        slots[UNIFORMS] = Slot::Uniforms;
    }
    if pass.kind == Kind::Geometry {
        slots[CAMERA] = Slot::Camera;
    }
    for (index, planned) in plan.resources.iter().enumerate() {
        let usage = pass.uses.iter().find(|usage| usage.resource == planned.resource.name);
        let binding = planned.binding as usize;
        if let (Some(usage), Element::Texture(format)) = (usage, planned.resource.element) {
            if usage.access == Access::Sampled {
                slots.resize(slots.len().max(binding + 1), Slot::Filler);
                let is_sample = |extent: &Extent| extent.name == SAMPLE;
                let several = planned.resource.extents.iter().any(is_sample);
                let samples = if several { Samples::Several } else { Samples::One };
                slots[binding] = Slot::Texture { index, sample_type: sample_type(format), samples };
            }
            continue;
        }
        // An element without words is declared nowhere: all of it is the key.
        let usage = usage.filter(|usage| usage.access != Access::Indirect);
        if let Some(usage) = usage.filter(|_| planned.binding >= FIRST_BINDING && has_words(plan, index)) {
            slots.resize(slots.len().max(binding + 1), Slot::Filler);
            slots[binding] = Slot::Resource { index, read_only: usage.access == Access::Read };
        }
    }
    slots
}

/// Whether a resource takes memory at all, in a frame of any size.
pub(crate) fn has_words(plan: &Plan, index: usize) -> bool {
    let words = plan.resources.get(index).map(|planned| &planned.words);
    // Pages of many fragments are no memory for one.
    let mut any_size = Values::of_code(plan);
    plan.symbols.iter().for_each(|(id, _)| any_size.set(id, 4096));
    words.is_some_and(|words| any_size.evaluate(words, "") != Ok(0))
}

/// The layout of a pass's bind group.
pub(crate) fn bind_group_layout(device: &wgpu::Device, pass: &Pass, slots: &[Slot]) -> wgpu::BindGroupLayout {
    let main = match pass.kind {
        Kind::Compute { .. } => wgpu::ShaderStages::COMPUTE,
        Kind::Geometry | Kind::Fullscreen => wgpu::ShaderStages::FRAGMENT,
    };
    let entries: Vec<wgpu::BindGroupLayoutEntry> =
        (0..).zip(slots).map(|(binding, slot)| entry(binding, *slot, main)).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(&pass.anchor), entries: &entries })
}

fn entry(binding: u32, slot: Slot, main: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    let has_dynamic_offset = slot == Slot::Frame;
    let (visibility, ty) = match slot {
        Slot::Texture { sample_type, samples, .. } => {
            let multisampled = samples == Samples::Several;
            let ty = wgpu::BindingType::Texture {
                sample_type,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled,
            };
            return wgpu::BindGroupLayoutEntry { binding, visibility: main, ty, count: None };
        }
        Slot::Filler => (wgpu::ShaderStages::NONE, wgpu::BufferBindingType::Uniform),
        Slot::Frame | Slot::Uniforms => (main, wgpu::BufferBindingType::Uniform),
        Slot::Camera => (wgpu::ShaderStages::VERTEX, wgpu::BufferBindingType::Uniform),
        Slot::Resource { read_only, .. } => (main, wgpu::BufferBindingType::Storage { read_only }),
    };
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
        count: None,
    }
}

/// Refuses a pass with more storage buffers than one stage may have.
pub(crate) fn check(device: &wgpu::Device, pass: &Pass, slots: &[Slot]) -> Result<(), Error> {
    let needed = slots.iter().filter(|slot| matches!(slot, Slot::Resource { .. })).count() as u64;
    let limit = u64::from(device.limits().max_storage_buffers_per_shader_stage);
    if needed <= limit {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("pass `{}`, in storage buffers,", pass.anchor),
        needed,
        limit,
        limit_name: "max_storage_buffers_per_shader_stage",
        hint: "request a device with the adapter's own limit",
    })
}
