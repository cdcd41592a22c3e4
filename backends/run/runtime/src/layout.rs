//! Bind group layouts: the resources that each pass uses, at the plan's bindings.
//!
//! Layouts are dense: a binding that a pass does not use has an entry that is visible to no stage. wgpu's Vulkan back end
//! renumbers the bindings of a layout consecutively and rewrites WGSL to match. SPIR-V that is passed through keeps the plan's
//! numbers, and only a dense layout keeps them unchanged.

use fragbuf_codegen::{FIRST_BINDING, Plan, PlannedResource};
use fragbuf_templates::vocabulary::{Access, Element, Kind, Pass, TextureDimension};

use crate::Error;
use crate::texture::sample_type;

/// The bindings of the description's uniforms and of the camera. The frame's block is at 0.
const UNIFORMS: usize = 1;
const CAMERA: usize = 2;

/// The content of one binding of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binding {
    /// The pass does not use this binding.
    Unused,
    /// The frame's block; a dynamic offset selects slice and iteration.
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
        dimension: wgpu::TextureViewDimension,
        samples: Samples,
    },
}

/// Whether a texture has several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Samples {
    One,
    Several,
}

/// Returns the bindings of a pass, indexed by their numbers.
pub(crate) fn bindings(plan: &Plan, pass: &Pass) -> Vec<Binding> {
    let mut bindings = vec![Binding::Frame, Binding::Unused, Binding::Unused];
    if !plan.variant.uniforms.is_empty() {
        bindings[UNIFORMS] = Binding::Uniforms;
    }
    if pass.kind == Kind::Geometry {
        bindings[CAMERA] = Binding::Camera;
    }
    for (index, planned) in plan.resources.iter().enumerate() {
        let usage = pass.uses.iter().find(|usage| usage.resource == planned.resource.name);
        let number = planned.binding as usize;
        if planned.is_texture() {
            if usage.is_some_and(|usage| usage.access == Access::Sampled) {
                bindings.resize(bindings.len().max(number + 1), Binding::Unused);
                bindings[number] = texture(index, planned);
            }
            continue;
        }
        let usage = usage.filter(|usage| usage.access != Access::Indirect);
        if let Some(usage) = usage.filter(|_| planned.binding >= FIRST_BINDING && plan.is_declared(planned)) {
            bindings.resize(bindings.len().max(number + 1), Binding::Unused);
            bindings[number] = Binding::Resource { index, read_only: usage.access == Access::Read };
        }
    }
    bindings
}

/// Returns the binding of a texture that a pass reads.
fn texture(index: usize, planned: &PlannedResource) -> Binding {
    let samples = if planned.is_multisampled() { Samples::Several } else { Samples::One };
    let (sample_type, dimension) = match planned.resource.element {
        Element::Texture(format) => (sample_type(format), wgpu::TextureViewDimension::D2),
        // The description filters; any format of floats can be bound.
        Element::Texels(TextureDimension::D3) => (UNFILTERED, wgpu::TextureViewDimension::D3),
        _ => (UNFILTERED, wgpu::TextureViewDimension::D2),
    };
    Binding::Texture { index, sample_type, dimension, samples }
}

const UNFILTERED: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

/// Creates the layout of a pass's bind group.
pub(crate) fn bind_group_layout(device: &wgpu::Device, pass: &Pass, bindings: &[Binding]) -> wgpu::BindGroupLayout {
    let main = match pass.kind {
        Kind::Compute { .. } => wgpu::ShaderStages::COMPUTE,
        Kind::Geometry | Kind::Fullscreen => wgpu::ShaderStages::FRAGMENT,
    };
    let entries: Vec<wgpu::BindGroupLayoutEntry> =
        (0..).zip(bindings).map(|(number, binding)| entry(number, *binding, main)).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(&pass.name), entries: &entries })
}

fn entry(number: u32, binding: Binding, main: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    let has_dynamic_offset = binding == Binding::Frame;
    let (visibility, ty) = match binding {
        Binding::Texture { sample_type, dimension, samples, .. } => {
            let multisampled = samples == Samples::Several;
            let ty = wgpu::BindingType::Texture { sample_type, view_dimension: dimension, multisampled };
            return wgpu::BindGroupLayoutEntry { binding: number, visibility: main, ty, count: None };
        }
        Binding::Unused => (wgpu::ShaderStages::NONE, wgpu::BufferBindingType::Uniform),
        Binding::Frame | Binding::Uniforms => (main, wgpu::BufferBindingType::Uniform),
        Binding::Camera => (wgpu::ShaderStages::VERTEX, wgpu::BufferBindingType::Uniform),
        Binding::Resource { read_only, .. } => (main, wgpu::BufferBindingType::Storage { read_only }),
    };
    wgpu::BindGroupLayoutEntry {
        binding: number,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
        count: None,
    }
}

/// Rejects a pass with more storage buffers than the device allows per stage.
pub(crate) fn check(device: &wgpu::Device, pass: &Pass, bindings: &[Binding]) -> Result<(), Error> {
    let needed = bindings.iter().filter(|binding| matches!(binding, Binding::Resource { .. })).count() as u64;
    let limit = u64::from(device.limits().max_storage_buffers_per_shader_stage);
    if needed <= limit {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("pass `{}`, in storage buffers,", pass.name),
        needed,
        limit,
        limit_name: "max_storage_buffers_per_shader_stage",
        help: "request a device with the adapter's own limit",
        shrinks_with_rows: false,
    })
}
