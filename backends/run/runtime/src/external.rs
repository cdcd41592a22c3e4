//! External textures: those that the caller creates and fills.
//!
//! Input: a plan and a texture of the caller. Output: the number of its resource, or an error with the required properties. This
//! module writes to no texture.

use fragbuf_codegen::{Plan, PlannedResource};
use fragbuf_frame::{Values, resource};
use fragbuf_templates::vocabulary::{Access, Element, TextureDimension};

use crate::Error;
use crate::texture::{texture_format, texture_samples};

/// Returns the number of the resource `name`, or of the description's texture `name`, if it is external and `texture` has the required properties.
pub(crate) fn accept(plan: &Plan, values: &Values, name: &str, texture: &wgpu::Texture) -> Result<usize, Error> {
    // A texture of the description has the name that the description gives it.
    let described = plan.variant.textures.iter().find(|texture| texture.name.value == name);
    let resource_name = described.map(|texture| texture.resource());
    let number = resource(plan, resource_name.as_deref().unwrap_or(name))?.0;
    let planned = &plan.resources[number];
    let format = match planned.resource.element {
        Element::Texture(format) => format,
        Element::Texels(dimension) => return accept_described(name, dimension, texture).map(|()| number),
        _ => return Err(not_external(name)),
    };
    if !planned.is_external() {
        return Err(not_external(name));
    }
    let size = wgpu::Extent3d { width: values.width(), height: values.height(), depth_or_array_layers: 1 };
    let (format, samples, usage) = (texture_format(format), texture_samples(plan, planned)?, usage(plan, planned));
    let is_plain = texture.dimension() == wgpu::TextureDimension::D2 && texture.mip_level_count() == 1;
    let fits = texture.size() == size && texture.format() == format && texture.sample_count() == samples;
    if is_plain && fits && texture.usage().contains(usage) {
        return Ok(number);
    }
    let found = texture.size();
    Err(Error::BadValue {
        name: format!("the texture `{name}`"),
        expected: format!(
            "as large as the frame, {} x {}, of format {format:?}, {samples} samples, one layer and one level, with the usages \
             {usage:?}; it is {} x {}, of format {:?}, {} samples, {} layers and {} levels, with {:?}",
            size.width,
            size.height,
            found.width,
            found.height,
            texture.format(),
            texture.sample_count(),
            found.depth_or_array_layers,
            texture.mip_level_count(),
            texture.usage(),
        ),
    })
}

/// Checks a texture of the description, which has any size and any format of floats.
fn accept_described(name: &str, dimension: TextureDimension, texture: &wgpu::Texture) -> Result<(), Error> {
    let (expected, in_words) = match dimension {
        TextureDimension::D2 => (wgpu::TextureDimension::D2, "two dimensions, one layer"),
        TextureDimension::D3 => (wgpu::TextureDimension::D3, "three dimensions"),
    };
    let is_float = matches!(texture.format().sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }));
    let layers = texture.size().depth_or_array_layers;
    let has_shape = texture.dimension() == expected && (dimension == TextureDimension::D3 || layers == 1);
    let is_plain = texture.mip_level_count() == 1 && texture.sample_count() == 1;
    if has_shape && is_plain && is_float && texture.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING) {
        return Ok(());
    }
    Err(Error::BadValue {
        name: format!("the texture `{name}`"),
        expected: format!(
            "of {in_words}, one level, one sample and a format of floats, with the usage TEXTURE_BINDING; it has the dimension \
             {:?}, {layers} layers, {} levels, {} samples, the format {:?} and {:?}",
            texture.dimension(),
            texture.mip_level_count(),
            texture.sample_count(),
            texture.format(),
            texture.usage(),
        ),
    })
}

/// Returns the error for a frame that begins without the texture `name`.
pub(crate) fn missing(name: &str) -> Error {
    Error::BadValue {
        name: format!("the texture `{name}`"),
        expected: "set with `Renderer::set_texture` before the frame begins, at the size of the frame".to_owned(),
    }
}

fn not_external(name: &str) -> Error {
    Error::BadValue {
        name: format!("`{name}`"),
        expected: "an external texture: the runtime allocates this resource".to_owned(),
    }
}

/// Returns the usages that the plan's passes need.
fn usage(plan: &Plan, planned: &PlannedResource) -> wgpu::TextureUsages {
    let uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    let of_texture = uses.filter(|usage| usage.resource == planned.resource.name);
    let usages = of_texture.map(|usage| match usage.access {
        Access::Attachment => wgpu::TextureUsages::RENDER_ATTACHMENT,
        _ => wgpu::TextureUsages::TEXTURE_BINDING,
    });
    usages.fold(wgpu::TextureUsages::empty(), |all, usage| all | usage)
}
