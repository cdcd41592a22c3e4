//! Textures that the caller brings, filled.
//!
//! In: a plan and a texture of the caller's. Out: whether the frame can take it, or what it must be. Nothing here writes to one.

use fragbuf_codegen::{Plan, Planned};
use fragbuf_frame::{Values, resource};
use fragbuf_templates::vocabulary::{Access, Element};

use crate::Error;
use crate::texture::{samples, texture_format};

/// The number of the resource `name`, if it is brought and `texture` can be it.
pub(crate) fn accept(plan: &Plan, values: &Values, name: &str, texture: &wgpu::Texture) -> Result<usize, Error> {
    let number = resource(plan, name)?.0;
    let planned = &plan.resources[number];
    let Element::Texture(format) = planned.resource.element else { return Err(not_brought(name)) };
    if !planned.is_brought() {
        return Err(not_brought(name));
    }
    let size = wgpu::Extent3d { width: values.width(), height: values.height(), depth_or_array_layers: 1 };
    let (format, samples, usage) = (texture_format(format), samples(plan, planned)?, usage(plan, planned));
    let is_plain = texture.dimension() == wgpu::TextureDimension::D2 && texture.mip_level_count() == 1;
    let fits = texture.size() == size && texture.format() == format && texture.sample_count() == samples;
    if is_plain && fits && texture.usage().contains(usage) {
        return Ok(number);
    }
    let found = texture.size();
    Err(Error::BadValue {
        name: format!("the texture `{name}`"),
        wanted: format!(
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

/// A frame cannot begin without `name`.
pub(crate) fn missing(name: &str) -> Error {
    Error::BadValue {
        name: format!("the texture `{name}`"),
        wanted: "brought before a frame begins, as large as the frame: `Renderer::set_texture`".to_owned(),
    }
}

fn not_brought(name: &str) -> Error {
    Error::BadValue { name: format!("`{name}`"), wanted: "left to the plan, which makes it itself".to_owned() }
}

/// What the plan's passes do with it.
fn usage(plan: &Plan, planned: &Planned) -> wgpu::TextureUsages {
    let uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    let own = uses.filter(|usage| usage.resource == planned.resource.name);
    let usages = own.map(|usage| match usage.access {
        Access::Attachment => wgpu::TextureUsages::RENDER_ATTACHMENT,
        _ => wgpu::TextureUsages::TEXTURE_BINDING,
    });
    usages.fold(wgpu::TextureUsages::empty(), |all, usage| all | usage)
}
