//! Finds the properties of vertices that are the components of requested attributes.
//!
//! An attribute with one component is the property of its name. One with several is a property per component, with the name and an ending:
//! `heat_x heat_y`, `heat_0 heat_1` or `heat_r heat_g`, each also without the `_`. Some names have other properties: `position` is `x y z`,
//! and `uv` is `u v` or `s t`. Lists are not attributes.

use super::header::Element;
use crate::attribute::{AttributeRequest, AvailableAttribute, MAX_COMPONENTS};
use crate::error::{FileError, FilePosition};
use crate::text::quoted;

/// The endings of the names of components.
const ENDINGS: [[&str; MAX_COMPONENTS]; 6] = [
    ["_x", "_y", "_z", "_w"],
    ["_0", "_1", "_2", "_3"],
    ["_r", "_g", "_b", "_a"],
    ["x", "y", "z", "w"],
    ["0", "1", "2", "3"],
    ["r", "g", "b", "a"],
];

/// Names of attributes, and the properties that writers of PLY use for them.
const USUAL: [(&[&str], &[&str]); 6] = [
    (&["position", "pos"], &["x", "y", "z"]),
    (&["normal"], &["nx", "ny", "nz"]),
    (UV, &["u", "v"]),
    (UV, &["s", "t"]),
    (UV, &["texture_u", "texture_v"]),
    (UV, &["texture_s", "texture_t"]),
];

const UV: &[&str] = &["uv", "st", "texcoord", "texcoord_0"];

/// The greatest number of properties that an error lists.
const MAX_LISTED: usize = 256;

/// A component of an attribute.
#[derive(Clone, Copy)]
pub(super) struct Component {
    /// The index of its attribute.
    pub(super) attribute: usize,
    pub(super) index: usize,
}

/// Returns the components that each property of `element` is. `Err`: an attribute has no properties; other elements of the file may have
/// them.
pub(super) fn find(
    element: &Element,
    elements: &[Element],
    attributes: &[AttributeRequest],
) -> Result<Vec<Vec<Component>>, FileError> {
    let mut found = vec![Vec::new(); element.properties.len()];
    for (attribute, request) in attributes.iter().enumerate() {
        let Some(properties) = properties(element, request) else {
            return Err(FileError::MissingAttribute(
                request.clone(),
                available(element),
                other(elements, element, request).map(Box::new),
            ));
        };
        for (index, property) in properties.into_iter().enumerate() {
            if let Some(components) = found.get_mut(property) {
                components.push(Component { attribute, index });
            }
        }
    }
    Ok(found)
}

/// Returns where the file has properties of this name that are no attribute of vertices: a list, or properties of another element.
fn other(elements: &[Element], vertices: &Element, request: &AttributeRequest) -> Option<(FilePosition, String)> {
    let name = &request.name;
    if let Some(list) = vertices.properties.iter().find(|property| property.list.is_some() && property.name == *name) {
        let reason = format!("the property {} is a list, and attributes are single values", quoted(&list.name));
        return Some((FilePosition::Line(list.line), reason));
    }
    let is_other = |element: &&Element| element.name != vertices.name;
    let named = |element: &Element| {
        let list = element.properties.iter().position(|property| property.name == *name);
        properties(element, request).and_then(|found| found.first().copied()).or(list)
    };
    let (element, index) = elements.iter().filter(is_other).find_map(|element| Some((element, named(element)?)))?;
    let property = element.properties.get(index)?;
    let reason = format!(
        "the property {} belongs to the element {}, and attributes are properties of `vertex`",
        quoted(&property.name),
        quoted(&element.name)
    );
    Some((FilePosition::Line(property.line), reason))
}

/// Returns the requests without those that are optional and that no element has.
pub(super) fn existing<'a>(
    elements: impl Iterator<Item = &'a Element>,
    attributes: &[AttributeRequest],
) -> Vec<AttributeRequest> {
    let elements: Vec<&Element> = elements.collect();
    let has = |request: &&AttributeRequest| elements.iter().all(|element| properties(element, request).is_some());
    attributes.iter().filter(|request| !request.is_optional || has(request)).cloned().collect()
}

/// Returns the indices of the properties of an attribute.
fn properties(element: &Element, request: &AttributeRequest) -> Option<Vec<usize>> {
    match request.components {
        1 => Some(vec![property(element, &request.name, "")?]),
        count @ 2..=MAX_COMPONENTS => ENDINGS
            .iter()
            .find_map(|endings| {
                endings.iter().take(count).map(|ending| property(element, &request.name, ending)).collect()
            })
            .or_else(|| usual(element, &request.name, count)),
        _ => None,
    }
}

/// Returns the indices of the usual properties of an attribute of this name.
fn usual(element: &Element, name: &str, count: usize) -> Option<Vec<usize>> {
    let rows = USUAL.iter().filter(|(names, properties)| {
        properties.len() == count && names.iter().any(|other| other.eq_ignore_ascii_case(name))
    });
    rows.into_iter()
        .find_map(|(_, properties)| properties.iter().map(|property| self::property(element, property, "")).collect())
}

/// Returns the index of the property `name` with an ending: the one with equal letters, or else one in another case.
fn property(element: &Element, name: &str, ending: &str) -> Option<usize> {
    let is_named = |found: &str, is_equal: fn(&str, &str) -> bool| {
        let (first, last) = found.split_at_checked(name.len()).unwrap_or_default();
        is_equal(first, name) && is_equal(last, ending)
    };
    let properties = || element.properties.iter().enumerate().filter(|(_, property)| property.list.is_none());
    // The last of equal names counts, as for positions.
    let equal = properties().rfind(|(_, property)| is_named(&property.name, |a, b| a == b));
    let found =
        equal.or_else(|| properties().find(|(_, property)| is_named(&property.name, str::eq_ignore_ascii_case)));
    found.map(|(index, _)| index)
}

/// Returns the attributes that can be requested of vertices.
fn available(element: &Element) -> Vec<AvailableAttribute> {
    let mut found = Vec::new();
    let slots = super::slots(element);
    let properties = element.properties.iter().zip(slots).take(MAX_LISTED);
    for (property, slot) in properties.filter(|(property, _)| property.list.is_none()) {
        if slot.is_none() {
            found.push(AvailableAttribute::new(&property.name, 1));
        }
        for endings in &ENDINGS {
            let Some(name) = endings.first().and_then(|ending| property.name.strip_suffix(ending)) else { continue };
            let components = endings.iter().take_while(|ending| self::property(element, name, ending).is_some());
            let components = components.count();
            let attribute = AvailableAttribute::new(name, components);
            // `nx ny nz` are the normal.
            let is_name = !name.is_empty() && !name.ends_with('_');
            if is_name && slot.is_none() && components > 1 && !found.contains(&attribute) {
                found.push(attribute);
            }
        }
    }
    for (names, properties) in USUAL {
        let has_all = properties.iter().all(|property| self::property(element, property, "").is_some());
        let attribute = names.first().map(|name| AvailableAttribute::new(name, properties.len()));
        found.extend(attribute.filter(|attribute| has_all && !found.contains(attribute)));
    }
    found
}
