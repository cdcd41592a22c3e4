//! Generates the textures that a pass reads, and the targets to which it writes the words of a fragment. Templates never name a texel.

use std::fmt::Write;

use fragbuf_templates::vocabulary::{Access, Element, Pass, TextureFormat};

use super::buffers::capitalised;
use super::fragment::construct;
use crate::{Linking, Plan, PlannedResource};

pub(super) fn text(plan: &Plan, pass: &Pass, linking: &Linking) -> String {
    let mut text = String::new();
    let is_sampled = |planned: &&PlannedResource| {
        pass.uses.iter().any(|u| u.resource == planned.resource.name && u.access == Access::Sampled)
    };
    let textures: Vec<Texture<'_>> = plan.resources.iter().filter(is_sampled).filter_map(Texture::of).collect();
    for texture in &textures {
        texture.declare(linking, &mut text);
        if texture.planned.part.is_none() {
            texture.load(&mut text);
        }
    }
    let mut resources: Vec<&str> = textures.iter().filter_map(|t| Some(t.planned.part.as_ref()?.of.as_str())).collect();
    resources.dedup();
    for resource in resources {
        entry_load(resource, &textures, &mut text);
    }
    key_only_loads(plan, &mut text);
    targets(plan, pass, &mut text);
    text
}

/// Generates `X_load` of a fragment without value words, and so without textures.
fn key_only_loads(plan: &Plan, text: &mut String) {
    for resource in plan.selection.rows.iter().flat_map(|selected| &selected.row.resources) {
        if plan.layout.values.is_empty() && matches!(resource.element, Element::ValueTextures(_)) {
            let name = &resource.name;
            let index: String = resource.extents.iter().map(|extent| format!("{}: u32, ", extent.name)).collect();
            let _ = writeln!(text, "fn {name}_load({index}key: u32) -> Packed {{\n    return Packed(key);\n}}\n");
        }
    }
}

/// A texture that a pass reads.
struct Texture<'a> {
    planned: &'a PlannedResource,
    format: TextureFormat,
}

impl<'a> Texture<'a> {
    fn of(planned: &'a PlannedResource) -> Option<Self> {
        match planned.resource.element {
            Element::Texture(format) => Some(Texture { planned, format }),
            _ => None,
        }
    }

    fn name(&self) -> &str {
        &self.planned.resource.name
    }

    fn is_multisampled(&self) -> bool {
        self.planned.is_multisampled()
    }

    fn declare(&self, linking: &Linking, text: &mut String) {
        let shape = if self.is_multisampled() { "multisampled_2d" } else { "2d" };
        let kind = match self.format {
            TextureFormat::Depth32Float => format!("texture_depth_{shape}"),
            TextureFormat::R32Uint | TextureFormat::Rg16Uint | TextureFormat::Depth24PlusStencil8 => {
                format!("texture_{shape}<u32>")
            }
            _ => format!("texture_{shape}<f32>"),
        };
        let (summary, group, binding) = (&self.planned.resource.summary, linking.group, self.planned.binding);
        let _ = writeln!(text, "/// {}.", capitalised(summary));
        let _ = writeln!(text, "@group({group}) @binding({binding}) var {}: {kind};\n", self.name());
    }

    /// Generates `X_load`, which returns the value of a texel.
    fn load(&self, text: &mut String) {
        let kind = match self.format {
            TextureFormat::R32Uint | TextureFormat::Rg16Uint | TextureFormat::Depth24PlusStencil8 => "u32",
            TextureFormat::R32Float | TextureFormat::Depth32Float => "f32",
            TextureFormat::Rg32Float => "vec2<f32>",
            TextureFormat::Rgba8Unorm | TextureFormat::Rgba16Float => "vec4<f32>",
        };
        let _ = writeln!(text, "fn {}_load({}) -> {kind} {{", self.name(), self.parameters());
        let _ = writeln!(text, "    return {};\n}}\n", self.read("pixel_texel(pixel)"));
    }

    fn parameters(&self) -> String {
        let index = self.planned.resource.extents.iter().map(|extent| format!("{}: u32", extent.name));
        index.collect::<Vec<_>>().join(", ")
    }

    /// Returns the expression that loads a texel.
    fn read(&self, position: &str) -> String {
        let last = if self.is_multisampled() { "sample" } else { "0" };
        let texel = format!("textureLoad({}, {position}, {last})", self.name());
        match self.format {
            TextureFormat::Depth32Float | TextureFormat::Rgba8Unorm | TextureFormat::Rgba16Float => texel,
            TextureFormat::R32Uint | TextureFormat::R32Float | TextureFormat::Depth24PlusStencil8 => {
                format!("{texel}.x")
            }
            TextureFormat::Rg16Uint => format!("word_of_halves({texel}.xy)"),
            TextureFormat::Rg32Float => format!("{texel}.xy"),
        }
    }
}

/// Generates `X_load` of a fragment with one texture per word. The key is a parameter if no texture stores it.
fn entry_load(resource: &str, textures: &[Texture<'_>], text: &mut String) {
    let field =
        |texture: &Texture<'_>| texture.planned.part.as_ref().filter(|p| p.of == resource).map(|p| p.field.clone());
    let parts: Vec<&Texture<'_>> = textures.iter().filter(|texture| field(texture).is_some()).collect();
    let Some(first) = parts.first() else { return };
    let has_key = field(first).as_deref() == Some("key");
    let key = if has_key { "" } else { ", key: u32" };
    let _ = writeln!(text, "fn {resource}_load({}{key}) -> Packed {{", first.parameters());
    text.push_str("    let texel = pixel_texel(pixel);\n");
    let words = parts.iter().map(|texture| texture.read("texel"));
    let words = (!has_key).then(|| "key".to_owned()).into_iter().chain(words);
    let _ = writeln!(text, "    return {};\n}}\n", construct("Packed", words));
}

/// Generates the outputs of a pass whose targets store the words of a fragment.
fn targets(plan: &Plan, pass: &Pass, text: &mut String) {
    let parts = pass.state.targets.iter().filter_map(|target| {
        let planned = plan.resource(&target.resource)?;
        Some((planned.part.as_ref()?.field.as_str(), Texture::of(planned)?.format))
    });
    let parts: Vec<(&str, TextureFormat)> = parts.collect();
    text.push_str("/// The words of a fragment, one per target.\nstruct Targets {\n");
    if parts.is_empty() {
        // A struct needs a member. No target is at its location, so its value is not written.
        text.push_str("    @location(0) nothing: u32,\n");
    }
    for (location, (field, format)) in parts.iter().enumerate() {
        let kind = if *format == TextureFormat::Rg16Uint { "vec2<u32>" } else { "u32" };
        let _ = writeln!(text, "    @location({location}) {field}: {kind},");
    }
    text.push_str("}\n\nfn fragment_targets(entry: Packed) -> Targets {\n");
    let values = parts.iter().map(|(field, format)| match format {
        TextureFormat::Rg16Uint => format!("word_halves(entry.{field})"),
        _ => format!("entry.{field}"),
    });
    let nothing = parts.is_empty().then(|| "0u".to_owned());
    let _ = writeln!(text, "    return {};\n}}\n", construct("Targets", nothing.into_iter().chain(values)));
}
