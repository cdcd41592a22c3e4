//! glTF 2.0, as JSON or GLB: the triangles of the default scene, with the transforms of nodes, normals, vertex colours and base
//! colour factors of materials in their alpha modes, and the default weights of morph targets. Textures, the pose of a skin and
//! animations are ignored.
//!
//! Everything is checked before it is used: the memory of the JSON, the length of every buffer, the type and range of every
//! accessor that is read, and that the nodes are a forest.

mod accessor;
mod buffers;
mod json;
mod material;
mod nodes;
mod primitive;
mod validate;

use std::path::Path;

use glam::Mat4;
use gltf::{Gltf, Node};

use crate::error::{Error, FileError, FilePosition};
use crate::limits::{Budget, OBJECT};
use crate::text::{foreign_message, without_mark};
use crate::{Object, Scene};
use primitive::Reader;

/// Reads the model of `path`, whose bytes are `bytes`. `color` is the colour of primitives without a material.
pub(crate) fn parse(bytes: &[u8], path: &Path, color: [f32; 4], budget: &Budget) -> Result<Scene, Error> {
    let (file, bytes) = (path.display().to_string(), without_mark(bytes));
    let mut model = document(bytes, budget).map_err(|error| error.in_file(&file))?;
    let blob = model.blob.take();
    let buffers = buffers::read(&model, blob, path, budget)?;
    let reader = Reader { buffers: &buffers, color, budget };
    scene(&model, &reader).map_err(|error| error.in_file(&file))
}

/// Parses and validates the JSON.
fn document(bytes: &[u8], budget: &Budget) -> Result<Gltf, FileError> {
    json::take(bytes, budget)?;
    let model = Gltf::from_slice_without_validation(bytes).map_err(|error| match error {
        gltf::Error::Deserialize(error) => {
            FileError::Malformed(FilePosition::Line(error.line()), foreign_message(&error))
        }
        other => FileError::whole(foreign_message(&other)),
    })?;
    validate::validate(model.as_json())?;
    Ok(model)
}

/// Returns the objects of the default scene: one per node with a mesh.
fn scene(model: &Gltf, reader: &Reader<'_>) -> Result<Scene, FileError> {
    nodes::check(model)?;
    let roots = model.default_scene().or_else(|| model.scenes().next());
    let roots = roots.ok_or_else(|| FileError::whole("the file has no scene"))?;
    let mut scene = Scene::default();
    let mut visited = vec![false; model.nodes().len()];
    let mut pending: Vec<(Node<'_>, Mat4)> = roots.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    pending.reverse();
    while let Some((node, outer)) = pending.pop() {
        if visited.get_mut(node.index()).is_some_and(|visited| std::mem::replace(visited, true)) {
            return Err(FileError::whole(format!("node {} occurs twice in scene {}", node.index(), roots.index())));
        }
        let transform = outer * Mat4::from_cols_array_2d(&node.transform().matrix());
        if let Some(mesh) = node.mesh() {
            let name = node.name().or(mesh.name()).unwrap_or_default().to_owned();
            reader.budget.take(1, OBJECT + name.len() as u64, "the scene's objects")?;
            let mut object = Object { name, ..Object::default() };
            // The joints of a skin place its mesh, and not the node.
            let placed = if node.skin().is_some() { Mat4::IDENTITY } else { transform };
            let weights = node.weights().or(mesh.weights()).unwrap_or_default();
            for primitive in mesh.primitives() {
                reader.primitive(&primitive, (&placed, weights), &mut object)?;
            }
            scene.objects.push(object);
        }
        let first = pending.len();
        pending.extend(node.children().map(|child| (child, transform)));
        if let Some(children) = pending.get_mut(first..) {
            children.reverse();
        }
    }
    Ok(scene)
}
