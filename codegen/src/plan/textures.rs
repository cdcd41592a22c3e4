//! Splits resources that are one in a row and one texture per word of a fragment in a plan.
//!
//! Input: the resources of the rows and the steps that use them. Output: one resource per texture, and steps that name the textures.
//! Textures follow buffers, because OpenGL guarantees fewer bindings for buffers than for textures.

use fragbuf_templates::vocabulary::{ColorTarget, Element, Pass, Resource, Step, Use};

use super::edit::for_each_pass;
use super::resource::Part;
use crate::Layout;

/// A resource of the plan, and the word that it stores if it is one of several textures.
pub(super) type PartOfResource = (Resource, Option<Part>);

/// Splits the resources, and replaces their names in the passes.
pub(super) fn split(resources: Vec<Resource>, steps: &mut [Step], layout: &Layout) -> Vec<PartOfResource> {
    let mut all: Vec<PartOfResource> = resources.into_iter().flat_map(|resource| textures(resource, layout)).collect();
    for_each_pass(steps, &mut |pass| name_textures(pass, &all));
    all.sort_by_key(|(resource, _)| matches!(resource.element, Element::Texture(_) | Element::Texels(_)));
    all
}

fn textures(resource: Resource, layout: &Layout) -> Vec<PartOfResource> {
    let (format, key) = match resource.element {
        Element::ValueTextures(format) => (format, None),
        Element::EntryTextures(format) => (format, Some("key")),
        _ => return vec![(resource, None)],
    };
    let fields = key.into_iter().chain(layout.values.iter().map(|word| word.field.as_str()));
    let texture = |field: &str| {
        let part = Part { of: resource.name.clone(), field: field.to_owned() };
        let texture = Resource {
            name: format!("{}_{field}", resource.name),
            element: Element::Texture(format),
            summary: format!("`{field}` of {}", resource.summary).into(),
            ..resource.clone()
        };
        (texture, Some(part))
    };
    fields.map(texture).collect()
}

/// Replaces each use and target of a split resource by one per texture.
fn name_textures(pass: &mut Pass, all: &[PartOfResource]) {
    let named = |name: &str| -> Vec<String> {
        let is_part = |part: &Option<Part>| part.as_ref().is_some_and(|part| part.of == name);
        let parts = all.iter().filter(|(_, part)| is_part(part)).map(|(resource, _)| resource.name.clone());
        let is_single = name == OUTPUT || all.iter().any(|(resource, _)| resource.name == name);
        parts.chain(is_single.then(|| name.to_owned())).collect()
    };
    let uses = std::mem::take(&mut pass.uses);
    let each = |usage: Use| named(&usage.resource).into_iter().map(move |resource| Use { resource, ..usage.clone() });
    pass.uses = uses.into_iter().flat_map(each).collect();
    let targets = std::mem::take(&mut pass.state.targets);
    let each = |target: ColorTarget| {
        named(&target.resource).into_iter().map(move |resource| ColorTarget { resource, ..target })
    };
    pass.state.targets = targets.into_iter().flat_map(each).collect();
}

/// The name of the caller's render target in the vocabulary.
const OUTPUT: &str = "output";
