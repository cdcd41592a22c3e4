//! glTF 2.0, as JSON or GLB: the triangles of the default scene, with the transforms of nodes, normals, vertex colours and base
//! colour factors of materials in their alpha modes, the default weights of morph targets, and requested attributes. Textures, the pose
//! of a skin and instances by an extension are not read, which is a warning; animations are ignored.
//!
//! Everything is checked before it is used: the memory of the JSON, the length of every buffer, the type and range of every
//! accessor that is read, and that the nodes are a forest.

mod accessor;
mod attributes;
mod buffers;
mod json;
mod locate;
mod material;
mod missing;
mod nodes;
mod primitive;
mod validate;

use std::path::Path;

use glam::DMat4;
use gltf::{Gltf, Mesh, Node};

use crate::attribute::AttributeRequest;
use crate::error::{Error, FileError, FilePosition};
use crate::limits::{Budget, OBJECT};
use crate::model::ModelObject;
use crate::text::{foreign_message, without_mark};
use crate::warnings::{FileWarnings, Message, WarningKind};
use locate::Text;
use primitive::Reader;

/// Reads the model of `path`, whose bytes are `bytes`. `color` is the colour of primitives without a material; `requests` are
/// attributes of their vertices.
pub(crate) fn parse(
    bytes: &[u8],
    path: &Path,
    (color, requests): ([f32; 4], &[AttributeRequest]),
    (budget, warnings): (&Budget, FileWarnings<'_>),
) -> Result<(Vec<ModelObject>, Vec<AttributeRequest>), Error> {
    let (file, bytes) = (path.display().to_string(), without_mark(bytes));
    let text = Text::of(bytes);
    let located = |error: FileError| text.located(error).in_file(&file);
    let mut model = document(bytes, budget).map_err(located)?;
    missing::warn(model.as_json(), text, warnings);
    let requests = attributes::existing(model.as_json(), requests).map_err(located)?;
    let blob = model.blob.take();
    let buffers = buffers::read(&model, blob, (path, text), budget)?;
    let reader =
        Reader { buffers: &buffers, root: model.as_json(), color, requests: &requests, text, budget, warnings };
    let objects = objects(&model, &reader).map_err(located)?;
    Ok((objects, requests))
}

/// Parses and validates the JSON.
fn document(bytes: &[u8], budget: &Budget) -> Result<Gltf, FileError> {
    json::take(bytes, budget)?;
    let parsed = Gltf::from_slice_without_validation(bytes);
    let model = match parsed {
        Err(gltf::Error::Deserialize(error)) => match missing::repaired(bytes, &error, budget)? {
            Some(model) => model,
            None => {
                return Err(json::invalid(&error));
            }
        },
        // The others are about the chunks of a GLB, which follow its header.
        parsed => parsed.map_err(|error| {
            FileError::Malformed(
                FilePosition::Byte(12),
                format!("the chunks of the GLB are invalid: {}", foreign_message(&error)),
            )
        })?,
    };
    validate::validate(model.as_json())?;
    Ok(model)
}

/// Returns the nodes of the default scene and its name in messages. If it has none, the nodes without a parent.
fn roots<'a>(model: &'a Gltf, reader: &Reader<'_>) -> (Vec<Node<'a>>, String) {
    let scene = model.default_scene().or_else(|| model.scenes().next());
    let nodes: Vec<Node<'_>> = scene.iter().flat_map(gltf::Scene::nodes).collect();
    let name = scene.as_ref().map_or("the file".to_owned(), |scene| format!("scene {}", scene.index()));
    if !nodes.is_empty() {
        return (nodes, name);
    }
    let message = || match scene.is_some() {
        true => Message::new(format!("{name} has no nodes"), "all nodes of the file are drawn"),
        false => Message::new("the file has no scene", "all its nodes are drawn"),
    };
    let position = || scene.as_ref().map_or(FilePosition::Whole, |scene| reader.text.position("scenes", scene.index()));
    reader.warnings.add(WarningKind::MissingScene, "", || (position(), message()));
    let mut is_root = vec![true; model.nodes().len()];
    for child in model.nodes().flat_map(|node| node.children()) {
        if let Some(is_root) = is_root.get_mut(child.index()) {
            *is_root = false;
        }
    }
    (model.nodes().zip(is_root).filter(|(_, is_root)| *is_root).map(|(node, _)| node).collect(), name)
}

/// Returns the objects: one per node with a mesh, or one per mesh if the file has no nodes.
fn objects(model: &Gltf, reader: &Reader<'_>) -> Result<Vec<ModelObject>, FileError> {
    nodes::check(model)?;
    let mut objects = Vec::new();
    let mut visited = vec![false; model.nodes().len()];
    let (roots, scene) = roots(model, reader);
    let mut pending: Vec<(Node<'_>, DMat4)> = roots.into_iter().map(|node| (node, DMat4::IDENTITY)).collect();
    if model.nodes().len() == 0 {
        for mesh in model.meshes() {
            let weights = mesh.weights().unwrap_or_default();
            objects.push(object(&mesh, mesh.name(), (&DMat4::IDENTITY, weights), reader)?);
        }
    }
    pending.reverse();
    while let Some((node, outer)) = pending.pop() {
        if visited.get_mut(node.index()).is_some_and(|visited| std::mem::replace(visited, true)) {
            let message = format!("node {} occurs twice in {scene}", node.index());
            return Err(FileError::whole(message).in_element("nodes", node.index()));
        }
        let transform =
            outer * DMat4::from_cols_array_2d(&node.transform().matrix().map(|column| column.map(f64::from)));
        if let Some(mesh) = node.mesh() {
            // The joints of a skin place its mesh, and not the node.
            let placed = if node.skin().is_some() { DMat4::IDENTITY } else { transform };
            let weights = node.weights().or(mesh.weights()).unwrap_or_default();
            objects.push(object(&mesh, node.name().or(mesh.name()), (&placed, weights), reader)?);
        }
        let first = pending.len();
        pending.extend(node.children().map(|child| (child, transform)));
        if let Some(children) = pending.get_mut(first..) {
            children.reverse();
        }
    }
    Ok(objects)
}

fn object(
    mesh: &Mesh<'_>,
    name: Option<&str>,
    (transform, weights): (&DMat4, &[f32]),
    reader: &Reader<'_>,
) -> Result<ModelObject, FileError> {
    let name = name.unwrap_or_default().to_owned();
    reader.budget.take(1, OBJECT + name.len() as u64, "the scene's objects")?;
    let mut object = ModelObject::new(name, reader.requests.len());
    for primitive in mesh.primitives() {
        let added = reader.primitive(&primitive, mesh.index(), (transform, weights), &mut object);
        added.map_err(|error| error.in_element("meshes", mesh.index()))?;
    }
    Ok(object)
}
