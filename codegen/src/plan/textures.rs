//! Resources that a row names once, and that are a texture for each word of a fragment.
//!
//! In: the rows' resources and the steps that touch them. Out: one resource per texture, and steps that name those. Textures
//! come after buffers, because OpenGL promises fewer bindings for buffers than for textures.

use fragbuf_templates::vocabulary::{Element, Pass, Resource, Step, Target, Use};

use super::Part;
use super::edit::for_each_pass;
use crate::Layout;

/// A resource of the plan, and the word that it holds if it is one of several.
pub(super) type Spread = (Resource, Option<Part>);

pub(super) fn spread(resources: Vec<Resource>, steps: &mut [Step], layout: &Layout) -> Vec<Spread> {
    let mut all: Vec<Spread> = resources.into_iter().flat_map(|resource| textures(resource, layout)).collect();
    for_each_pass(steps, &mut |pass| name_textures(pass, &all));
    all.sort_by_key(|(resource, _)| matches!(resource.element, Element::Texture(_)));
    all
}

fn textures(resource: Resource, layout: &Layout) -> Vec<Spread> {
    let (format, key) = match resource.element {
        Element::BesideTextures(format) => (format, None),
        Element::EntryTextures(format) => (format, Some("key")),
        _ => return vec![(resource, None)],
    };
    let fields = key.into_iter().chain(layout.beside.iter().map(|word| word.field.as_str()));
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

/// What a pass does with the row's name it does with every texture.
fn name_textures(pass: &mut Pass, all: &[Spread]) {
    let named = |name: &str| -> Vec<String> {
        let is_part = |part: &Option<Part>| part.as_ref().is_some_and(|part| part.of == name);
        let parts = all.iter().filter(|(_, part)| is_part(part)).map(|(resource, _)| resource.name.clone());
        let is_whole = name == OUTPUT || all.iter().any(|(resource, _)| resource.name == name);
        parts.chain(is_whole.then(|| name.to_owned())).collect()
    };
    let uses = std::mem::take(&mut pass.uses);
    let each = |usage: Use| named(&usage.resource).into_iter().map(move |resource| Use { resource, ..usage.clone() });
    pass.uses = uses.into_iter().flat_map(each).collect();
    let targets = std::mem::take(&mut pass.state.targets);
    let each = |target: Target| named(&target.resource).into_iter().map(move |resource| Target { resource, ..target });
    pass.state.targets = targets.into_iter().flat_map(each).collect();
}

/// The vocabulary's name for the caller's own target.
const OUTPUT: &str = "output";
