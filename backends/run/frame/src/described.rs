//! The textures of a description, which the caller of a device sets.

use fragbuf_codegen::{Plan, ResourceId};
use fragbuf_templates::vocabulary::TextureDimension;

use crate::Error;

/// The most texels along a side of a texture.
pub const MAX_TEXTURE_SIDE: u32 = 16_384;

/// Returns the resource of the texture that a description calls `name`, if it can have this size: columns, rows and slices.
pub fn described_texture(plan: &Plan, name: &str, size: [u32; 3]) -> Result<ResourceId, Error> {
    let bad = |expected: String| Error::BadValue { name: format!("the texture `{name}`"), expected };
    let textures = &plan.variant.textures;
    let Some(texture) = textures.iter().find(|texture| texture.name.value == name) else {
        let known: Vec<String> = textures.iter().map(|texture| format!("`{}`", texture.name.value)).collect();
        return Err(bad(match known.as_slice() {
            [] => "declared in the description, which has no textures".to_owned(),
            _ => format!("one of those that the description declares: {}", known.join(", ")),
        }));
    };
    let [width, height, slices] = size;
    if size.iter().any(|length| !(1..=MAX_TEXTURE_SIDE).contains(length)) {
        return Err(bad(format!(
            "of 1 to {MAX_TEXTURE_SIDE} texels along each side, but has {width} x {height} x {slices}"
        )));
    }
    if texture.dimension.value == TextureDimension::D2 && slices != 1 {
        return Err(bad(format!("of two dimensions, but has {slices} slices")));
    }
    plan.resource_id(&texture.resource()).ok_or_else(|| bad("in the plan".to_owned()))
}
