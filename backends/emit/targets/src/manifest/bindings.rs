//! Writes the `bindings` of a pass: what its text declares, as entries of a bind group layout.

use fragbuf_codegen::{FIRST_BINDING, PlannedResource};
use fragbuf_templates::vocabulary::{Element, TextureFormat};
use serde_json::{Map, Value, json};

use super::resources::texture_format;
use super::{CAMERA, Context, FRAME, UNIFORMS};
use crate::emission::stage_name;
use crate::{Binding, BindingKind, SampleType};

/// Adds the bindings of a pass to its step. The top level is that of the plan's first target; targets whose text declares something else
/// are in `bindings_of`.
pub(super) fn insert(context: &Context<'_>, pass: usize, step: &mut Map<String, Value>) {
    let declared = |passes: &Vec<Vec<Binding>>| -> Option<Value> {
        Some(passes.get(pass)?.iter().filter_map(|one| binding(context, one)).collect())
    };
    let mut all = context.bindings.iter().filter_map(|(target, passes)| Some((target.name, declared(passes)?)));
    let Some((_, first)) = all.next() else { return };
    let others: Map<String, Value> = all
        .filter(|(_, bindings)| *bindings != first)
        .map(|(target, bindings)| (target.to_owned(), bindings))
        .collect();
    step.insert("bindings".into(), first);
    if !others.is_empty() {
        step.insert("bindings_of".into(), others.into());
    }
}

fn binding(context: &Context<'_>, binding: &Binding) -> Option<Value> {
    let planned = context.plan.resources.iter().find(|planned| planned.binding == binding.binding);
    let name = match binding.binding {
        FRAME => "frame",
        UNIFORMS => "uniforms",
        CAMERA => "camera",
        FIRST_BINDING.. => &planned?.resource.name,
    };
    let stages: Vec<&str> = binding.stages.iter().map(|stage| stage_name(*stage)).collect();
    let mut value = json!({
        "name": name,
        "group": context.group,
        "binding": binding.binding,
        "opengl_binding": context.opengl.point(binding.binding),
        "stages": stages,
    });
    match &binding.kind {
        BindingKind::Uniform => value["type"] = "uniform".into(),
        BindingKind::Storage { read_only, .. } => {
            value["type"] = if *read_only { "read-only-storage" } else { "storage" }.into();
        }
        BindingKind::Texture { sample_type, dimension, multisampled } => {
            let format = planned.and_then(format);
            value["type"] = "texture".into();
            value["sample_type"] = sample_name(*sample_type, *multisampled, format).into();
            value["view_dimension"] = dimension.keyword().into();
            value["multisampled"] = (*multisampled).into();
            value["aspect"] = aspect(*sample_type, format).into();
        }
        BindingKind::StorageTexture { access, format } => {
            value["type"] = "storage-texture".into();
            value["access"] = (*access).into();
            value["format"] = format.as_str().into();
            value["view_dimension"] = "2d".into();
        }
    }
    Some(value)
}

fn format(planned: &PlannedResource) -> Option<TextureFormat> {
    match planned.resource.element {
        Element::Texture(format) => Some(format),
        _ => None,
    }
}

/// Returns WebGPU's sample type. Textures of 32-bit floats, and those with several samples, cannot be filtered.
fn sample_name(sample_type: SampleType, multisampled: bool, format: Option<TextureFormat>) -> &'static str {
    let is_filtered = matches!(format.map(texture_format), Some("rgba8unorm" | "rgba16float")) && !multisampled;
    match sample_type {
        SampleType::Float if is_filtered => "float",
        SampleType::Float => "unfilterable-float",
        SampleType::Uint => "uint",
        SampleType::Sint => "sint",
        SampleType::Depth => "depth",
    }
}

/// Returns the aspect of the texture's view.
fn aspect(sample_type: SampleType, format: Option<TextureFormat>) -> &'static str {
    match (format, sample_type) {
        (Some(TextureFormat::Depth24PlusStencil8), SampleType::Uint) => "stencil-only",
        (Some(TextureFormat::Depth24PlusStencil8 | TextureFormat::Depth32Float), _) => "depth-only",
        _ => "all",
    }
}
