//! Generates how closures read the textures and images of a description: declarations of textures, texels with coordinates inside the
//! border, and filters. Filters are computed here, not by samplers, so that every device gives the same result and 32-bit floats can be
//! filtered in browsers.

use std::fmt::Write;

use fragbuf_model::{Image, Texture, TextureDimension};
use fragbuf_templates::vocabulary::{Access, Pass};

use super::buffers::capitalised;
use crate::plan::{IMAGE, IMAGE_WORDS};
use crate::{Linking, Plan, PlannedResource};

pub(super) fn text(plan: &Plan, pass: &Pass, linking: &Linking) -> String {
    let mut text = String::new();
    let used = |name: &str, access| pass.uses.iter().any(|usage| usage.resource == name && usage.access == access);
    for texture in &plan.variant.textures {
        let name = texture.resource();
        if let Some(planned) = plan.resource(&name).filter(|_| used(&name, Access::Sampled)) {
            declare(planned, texture.dimension.value, linking, &mut text);
            lookups(&name, texture, &mut text);
        }
    }
    for image in &plan.variant.images {
        let name = image.resource();
        if used(&name, Access::Read) {
            pixels(&name, &mut text);
        }
        if used(&name, Access::Plain) {
            stored(image, &mut text);
        }
    }
    text
}

/// Returns the image that a pass computes.
pub(super) fn image_of<'a>(plan: &'a Plan, pass: &Pass) -> Option<&'a Image> {
    let number = pass.constants.iter().find(|(name, _)| name == IMAGE).map(|(_, number)| *number)?;
    plan.variant.images.get(number as usize)
}

fn declare(planned: &PlannedResource, dimension: TextureDimension, linking: &Linking, text: &mut String) {
    let (summary, group, binding) = (&planned.resource.summary, linking.group, planned.binding);
    let (name, shape) = (&planned.resource.name, dimension.keyword());
    let _ = writeln!(text, "/// {}.", capitalised(summary));
    let _ = writeln!(text, "@group({group}) @binding({binding}) var {name}: texture_{shape}<f32>;\n");
}

/// Generates the methods of a texture.
fn lookups(name: &str, texture: &Texture, text: &mut String) {
    let dimension = texture.dimension.value;
    let axes = dimension.axes();
    let (parameters, coordinates) = match dimension {
        TextureDimension::D2 => ("x: i32, y: i32", "x, y"),
        TextureDimension::D3 => ("x: i32, y: i32, z: i32", "x, y, z"),
    };
    let linear = match dimension {
        TextureDimension::D2 => BILINEAR,
        TextureDimension::D3 => TRILINEAR,
    };
    for (length, component) in ["width", "height", "depth"].iter().zip(["x", "y", "z"]).take(axes) {
        let _ =
            writeln!(text, "fn {length}_{name}() -> u32 {{\n    return textureDimensions({name}).{component};\n}}\n");
    }
    let (whole, float) = (format!("vec{axes}<i32>"), format!("vec{axes}<f32>"));
    let _ = writeln!(
        text,
        "/// Returns a texel of `{name}`; coordinates beyond the border are those of the nearest texel.
fn load_{name}({parameters}) -> vec4<f32> {{
    let last = {whole}(textureDimensions({name})) - 1;
    return textureLoad({name}, clamp({whole}({coordinates}), {whole}(0), last), 0);
}}

/// Returns the value of `{name}` at a place from 0 to 1, linear between texels.
fn sample_{name}(at: {float}) -> vec4<f32> {{
    let place = clamp(at, {float}(0.0), {float}(1.0)) * {float}(textureDimensions({name})) - 0.5;
    let texel = {whole}(floor(place));
    let part = place - floor(place);
{linear}}}

/// Returns the texel of `{name}` at a place from 0 to 1.
fn sample_nearest_{name}(at: {float}) -> vec4<f32> {{
    let texel = {whole}(floor(clamp(at, {float}(0.0), {float}(1.0)) * {float}(textureDimensions({name}))));
    return load_{name}({texels});
}}
",
        linear = linear.replace("NAME", name),
        texels = if axes == 2 { "texel.x, texel.y" } else { "texel.x, texel.y, texel.z" },
    );
}

const BILINEAR: &str = "    let above = mix(load_NAME(texel.x, texel.y), load_NAME(texel.x + 1, texel.y), part.x);
    let below = mix(load_NAME(texel.x, texel.y + 1), load_NAME(texel.x + 1, texel.y + 1), part.x);
    return mix(above, below, part.y);
";

const TRILINEAR: &str = "    var slices: array<vec4<f32>, 2>;
    for (var slice = 0; slice < 2; slice++) {
        let z = texel.z + slice;
        let above = mix(load_NAME(texel.x, texel.y, z), load_NAME(texel.x + 1, texel.y, z), part.x);
        let below = mix(load_NAME(texel.x, texel.y + 1, z), load_NAME(texel.x + 1, texel.y + 1, z), part.x);
        slices[slice] = mix(above, below, part.y);
    }
    return mix(slices[0], slices[1], part.z);
";

/// Generates the methods of an image.
fn pixels(name: &str, text: &mut String) {
    let channels: Vec<String> = (0..IMAGE_WORDS).map(|channel| format!("{name}_load({channel}u, pixel)")).collect();
    let _ = writeln!(
        text,
        "fn width_{name}() -> u32 {{
    return frame.width;
}}

fn height_{name}() -> u32 {{
    return frame.height;
}}

/// Returns the value of `{name}` at the pixel `dx` to the right and `dy` below; beyond the border, that of the nearest pixel.
fn at_{name}(dx: i32, dy: i32) -> vec4<f32> {{
    let pixel = neighbouring_pixel(resolved, dx, dy);
    return bitcast<vec4<f32>>(vec4<u32>({}));
}}
",
        channels.join(", ")
    );
}

/// Generates the function that stores the value of an image.
fn stored(image: &Image, text: &mut String) {
    let name = image.resource();
    let stores = (0..IMAGE_WORDS).zip(["x", "y", "z", "w"]);
    let stores: String =
        stores.map(|(channel, part)| format!("    {name}_store({channel}u, pixel, words.{part});\n")).collect();
    let _ = writeln!(
        text,
        "/// Stores the value of the image `{}` at a pixel.
fn image_store(pixel: u32, value: vec4<f32>) {{
    let words = bitcast<vec4<u32>>(value);
{stores}}}
",
        image.name.value
    );
}
