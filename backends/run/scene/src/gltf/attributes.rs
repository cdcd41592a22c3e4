//! The attributes of primitives that the caller requests: `_NAME` of applications, `COLOR_n` and `TEXCOORD_n`.
//!
//! The `gltf` crate iterates over attributes with a panic where a name is not valid, so their names are read from the JSON.

use gltf::accessor::{DataType, Dimensions};
use gltf::json::Root;
use gltf::json::mesh::Primitive;
use gltf::json::validation::Checked;
use gltf::{Accessor, Semantic};

use super::accessor::{Elements, Types};
use super::primitive::Reader;
use crate::attribute::{AttributeRequest, AvailableAttribute};
use crate::error::FileError;
use crate::warnings::{Message, WarningKind};

/// The greatest number of attributes of a model that an error lists.
const MAX_LISTED: usize = 256;

const COMPONENTS: &[DataType] =
    &[DataType::F32, DataType::I8, DataType::U8, DataType::I16, DataType::U16, DataType::U32];

/// The numbers of a requested attribute of a primitive.
pub(super) struct Values<'a> {
    request: &'a AttributeRequest,
    /// `None`: zeros.
    elements: Option<Elements<'a>>,
}

impl Values<'_> {
    /// Adds the words of a vertex to a list.
    pub(super) fn add(&self, vertex: usize, mesh: usize, reader: &Reader<'_>, words: &mut Vec<u32>) {
        for component in 0..self.request.components {
            let value = self.elements.as_ref().map_or(0.0, |elements| match component < elements.components {
                true => elements.number(vertex, component),
                // A colour without alpha is opaque.
                false => 1.0,
            });
            let position = || reader.text.position("meshes", mesh);
            words.push(self.request.word(value, position, reader.warnings));
        }
    }
}

/// Returns the requests without those that are optional and that no primitive of the model has. `Err`: no primitive has one of the others.
pub(super) fn existing(root: &Root, attributes: &[AttributeRequest]) -> Result<Vec<AttributeRequest>, FileError> {
    let primitives = || root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let is_missing = |request: &&AttributeRequest| {
        !primitives().filter_map(|primitive| find(primitive, request)).any(|(semantic, accessor)| {
            let dimensions = root.accessors.get(accessor).map(|accessor| &accessor.type_);
            matches!(dimensions, Some(Checked::Valid(found)) if allowed(request, &semantic).contains(found))
        })
    };
    let Some(request) = attributes.iter().find(|request| !request.is_optional && is_missing(request)) else {
        return Ok(attributes.iter().filter(|request| !is_missing(request)).cloned().collect());
    };
    let mut available = Vec::new();
    for (semantic, accessor) in primitives().flat_map(|primitive| &primitive.attributes).take(MAX_LISTED) {
        let Checked::Valid(semantic) = semantic else { continue };
        let dimensions = root.accessors.get(accessor.value()).map(|accessor| &accessor.type_);
        if let (Some(name), Some(Checked::Valid(found))) = (name(semantic), dimensions) {
            let attribute = AvailableAttribute::new(&name, found.multiplicity());
            if is_vector(*found) && !available.contains(&attribute) {
                available.push(attribute);
            }
        }
    }
    Err(FileError::MissingAttribute(request.clone(), available, None))
}

impl<'a> Reader<'a> {
    /// Returns the requested attributes of a primitive with `count` vertices.
    pub(super) fn attributes(
        &self,
        primitive: &gltf::Primitive<'_>,
        mesh: usize,
        count: usize,
    ) -> Result<Vec<Values<'a>>, FileError> {
        let number = primitive.index();
        let json = self.root.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(number));
        let values = |request: &'a AttributeRequest| {
            let found = json.and_then(|json| find(json, request));
            let accessor = found.and_then(|(semantic, _)| Some((primitive.get(&semantic)?, semantic)));
            let Some((accessor, semantic)) = accessor else {
                let name = &request.name;
                let text = || format!("primitive {number} of mesh {mesh} has no `{name}`");
                let message = || Message::new(text(), "0 is used");
                self.warnings
                    .add(WarningKind::MissingAttribute, name, || (self.text.position("meshes", mesh), message()));
                return Ok(Values { request, elements: None });
            };
            let elements = self.elements(&accessor, allowed(request, &semantic))?;
            if elements.count != count {
                let (name, found) = (semantic.to_string(), elements.count);
                let message = format!("primitive {number}: {found} of {name}, and {count} of POSITION");
                return Err(FileError::whole(message));
            }
            Ok(Values { request, elements: Some(elements) })
        };
        self.requests.iter().map(values).collect()
    }

    fn elements(&self, accessor: &Accessor<'_>, dimensions: &'static [Dimensions]) -> Result<Elements<'a>, FileError> {
        Elements::of(accessor, &Types { dimensions, components: COMPONENTS }, self.buffers)
    }
}

/// Returns the semantic of a requested attribute in a primitive, and the index of its accessor. Case is ignored. Those that the
/// format defines have precedence over those of applications, which are before them in the map.
fn find(primitive: &Primitive, request: &AttributeRequest) -> Option<(Semantic, usize)> {
    primitive.attributes.iter().rev().find_map(|(semantic, accessor)| {
        let Checked::Valid(semantic) = semantic else { return None };
        let is_equal = name(semantic).is_some_and(|name| name.eq_ignore_ascii_case(&request.name));
        is_equal.then(|| (semantic.clone(), accessor.value()))
    })
}

/// Returns the name to request for a semantic.
fn name(semantic: &Semantic) -> Option<String> {
    match semantic {
        Semantic::Extras(name) => Some(name.to_lowercase()),
        Semantic::Colors(set) => Some(format!("color_{set}")),
        Semantic::TexCoords(set) => Some(format!("texcoord_{set}")),
        _ => None,
    }
}

/// Returns the types that an attribute may have. Colours may have an alpha or not.
fn allowed(request: &AttributeRequest, semantic: &Semantic) -> &'static [Dimensions] {
    match (request.components, semantic) {
        (3 | 4, Semantic::Colors(_)) => &[Dimensions::Vec3, Dimensions::Vec4],
        (1, _) => &[Dimensions::Scalar],
        (2, _) => &[Dimensions::Vec2],
        (3, _) => &[Dimensions::Vec3],
        (4, _) => &[Dimensions::Vec4],
        _ => &[],
    }
}

fn is_vector(dimensions: Dimensions) -> bool {
    matches!(dimensions, Dimensions::Scalar | Dimensions::Vec2 | Dimensions::Vec3 | Dimensions::Vec4)
}
