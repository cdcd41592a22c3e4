//! Writes the `resources` of a manifest: buffers and textures, their sizes and how they begin.

use fragbuf_codegen::PlannedResource;
use fragbuf_templates::vocabulary::{Element, Init, Lifetime, TextureDimension, TextureFormat};
use serde_json::{Value, json};

use super::Context;
use crate::BindingKind;

/// Returns the resources of a plan.
pub(super) fn resources(context: &Context<'_>) -> Value {
    context.plan.resources.iter().map(|planned| resource(context, planned)).collect()
}

fn resource(context: &Context<'_>, planned: &PlannedResource) -> Value {
    let resource = &planned.resource;
    let extents: Vec<Value> =
        resource.extents.iter().map(|extent| json!({ "name": extent.name, "length": extent.length.0 })).collect();
    let element = match resource.element {
        Element::Texture(format) => format!("texture:{}", texture_format(format)),
        Element::Texels(dimension) => format!("texels:{}", dimension.keyword()),
        Element::Word => "word".to_owned(),
        Element::Word64 => "word64".to_owned(),
        Element::Entry => "entry".to_owned(),
        Element::Value => "value".to_owned(),
        Element::ValueTextures(format) => format!("value-textures:{}", texture_format(format)),
        Element::EntryTextures(format) => format!("entry-textures:{}", texture_format(format)),
    };
    let init = match resource.init {
        Init::Clear(value) => json!({ "clear": value }),
        Init::Keep => json!("keep"),
        Init::External => json!("external"),
    };
    let mut value = json!({
        "name": resource.name,
        "group": context.group,
        "binding": planned.binding,
        "opengl_binding": context.opengl.point(planned.binding),
        "element": element,
        "extents": extents,
        "words": planned.words.to_string(),
        "bytes": format!("4 * ({})", planned.words),
        "init": init,
        "lifetime": if resource.lifetime == Lifetime::Persistent { "persistent" } else { "frame" },
        "summary": resource.summary,
    });
    match resource.element {
        Element::Texture(format) => value["texture"] = texture(planned, format),
        Element::Texels(dimension) => value["texture"] = described(context, planned, dimension),
        _ => {
            let least = least_bytes(context, planned.binding);
            value["least_bytes"] = least.into();
            value["bytes"] = format!("max({least}, 4 * ({}))", planned.words).into();
        }
    }
    value
}

/// Returns the least size of a buffer that can be bound in every pass. APIs create and bind no buffer without bytes, and WebGPU none that
/// is smaller than one element.
fn least_bytes(context: &Context<'_>, number: u32) -> u32 {
    let declared = context.bindings.iter().flat_map(|(_, passes)| passes.iter().flatten());
    let bytes = declared.filter(|binding| binding.binding == number).map(|binding| match &binding.kind {
        BindingKind::Storage { least_bytes, .. } => *least_bytes,
        _ => 0,
    });
    bytes.max().unwrap_or(0).max(4)
}

/// Returns how to create a texture. It has the size of the frame; `clear` has one value per channel of its format. `word` is the
/// field of an entry that it stores, if an entry is spread over one texture per word.
fn texture(planned: &PlannedResource, format: TextureFormat) -> Value {
    let resource = &planned.resource;
    let clear = match resource.init {
        Init::Clear(word) => texel(format, word),
        _ => Value::Null,
    };
    json!({
        "format": texture_format(format),
        "samples": planned.sample_count().map_or("1", |count| &count.formula().0),
        "clear": clear,
        "word": planned.part.as_ref().map(|part| &part.field),
    })
}

/// Returns what a follower must know of a texture of the description: its name there, and its dimension. It has any size and any format of
/// floats; `format` is one that every API has.
fn described(context: &Context<'_>, planned: &PlannedResource, dimension: TextureDimension) -> Value {
    let textures = &context.plan.variant.textures;
    let name = textures.iter().find(|texture| texture.resource() == planned.resource.name);
    json!({
        "format": "rgba32float",
        "samples": "1",
        "clear": null,
        "word": null,
        "described": name.map(|texture| &texture.name.value),
        "view_dimension": dimension.keyword(),
    })
}

/// Returns the channels of a texel that stores this word.
pub(super) fn texel(format: TextureFormat, word: u32) -> Value {
    match format {
        TextureFormat::R32Uint => json!([word]),
        TextureFormat::Rg16Uint => json!([word & 0xffff, word >> 16]),
        TextureFormat::Rgba8Unorm => json!(word.to_le_bytes().map(|byte| f64::from(byte) / 255.0)),
        TextureFormat::R32Float => json!([f32::from_bits(word)]),
        TextureFormat::Rg32Float => vec![f32::from_bits(word); 2].into(),
        TextureFormat::Rgba16Float => vec![f32::from_bits(word); 4].into(),
        TextureFormat::Depth32Float => json!({ "depth": f32::from_bits(word) }),
        TextureFormat::Depth24PlusStencil8 => {
            json!({ "depth": f64::from(word >> 8) / 16_777_215.0, "stencil": word & 0xff })
        }
    }
}

pub(super) fn texture_format(format: TextureFormat) -> &'static str {
    match format {
        TextureFormat::R32Uint => "r32uint",
        TextureFormat::Rg16Uint => "rg16uint",
        TextureFormat::R32Float => "r32float",
        TextureFormat::Rg32Float => "rg32float",
        TextureFormat::Rgba8Unorm => "rgba8unorm",
        TextureFormat::Rgba16Float => "rgba16float",
        TextureFormat::Depth32Float => "depth32float",
        TextureFormat::Depth24PlusStencil8 => "depth24plus-stencil8",
    }
}
