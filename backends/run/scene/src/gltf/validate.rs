//! Checks what the reader of a model relies on: that every index is in range, that every type is known, and that no required
//! extension changes the triangles.
//!
//! The validation of the `gltf` crate is not used: it panics where POSITION names an accessor that does not exist, and rejects
//! models with parts that are not read here.

use std::ops::RangeInclusive;

use gltf::json::accessor::Accessor;
use gltf::json::buffer::Stride;
use gltf::json::mesh::Primitive;
use gltf::json::validation::Checked;
use gltf::json::{Index, Node, Root};

use super::missing::unsupported_version;
use crate::error::FileError;
use crate::text::quoted;

/// Extensions that may be required: those of lights, textures and materials do not change what is read, and the others are read.
const SUPPORTED: [&str; 8] = [
    "KHR_mesh_quantization",
    "KHR_lights_punctual",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "KHR_xmp_json_ld",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "EXT_lights_image_based",
];

/// The prefix of the names of extensions of materials.
const MATERIALS: &str = "KHR_materials_";

/// The strides that the format allows.
const STRIDES: RangeInclusive<usize> = 4..=252;

/// Checks a model.
pub(super) fn validate(root: &Root) -> Result<(), FileError> {
    if !root.asset.version.starts_with("2.") {
        return Err(unsupported_version(&root.asset.version));
    }
    for (number, extension) in root.extensions_required.iter().enumerate() {
        if !SUPPORTED.contains(&extension.as_str()) && !extension.starts_with(MATERIALS) {
            let message = format!("the required extension {} is not supported", quoted(extension));
            return Err(FileError::whole(message).in_element("extensionsRequired", number));
        }
    }
    let default = in_range(root.scene.iter(), root.scenes.len(), "the default scene");
    default.map_err(|error| error.in_element("scene", 0))?;
    for (number, scene) in root.scenes.iter().enumerate() {
        let nodes = in_range(&scene.nodes, root.nodes.len(), &format!("scene {number}: its node"));
        nodes.map_err(|error| error.in_element("scenes", number))?;
    }
    for (number, node) in root.nodes.iter().enumerate() {
        validate_node(root, node, &format!("node {number}")).map_err(|error| error.in_element("nodes", number))?;
    }
    for (number, mesh) in root.meshes.iter().enumerate() {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let valid = validate_primitive(root, primitive, &format!("mesh {number}, primitive {index}"));
            valid.map_err(|error| error.in_element("meshes", number))?;
        }
    }
    for (number, accessor) in root.accessors.iter().enumerate() {
        let valid = validate_accessor(root, accessor, &format!("accessor {number}"));
        valid.map_err(|error| error.in_element("accessors", number))?;
    }
    for (number, material) in root.materials.iter().enumerate() {
        let mode = known(&material.alpha_mode, &format!("material {number}: its alpha mode"));
        mode.map_err(|error| error.in_element("materials", number))?;
    }
    for (number, view) in root.buffer_views.iter().enumerate() {
        let buffer = in_range([&view.buffer], root.buffers.len(), &format!("buffer view {number}: its buffer"));
        buffer.map_err(|error| error.in_element("bufferViews", number))?;
        if let Some(Stride(stride)) = view.byte_stride.filter(|Stride(stride)| !STRIDES.contains(stride)) {
            let message = format!("buffer view {number}: a stride of {stride} bytes is not from 4 to 252");
            return Err(FileError::whole(message).in_element("bufferViews", number));
        }
    }
    Ok(())
}

fn validate_node(root: &Root, node: &Node, name: &str) -> Result<(), FileError> {
    in_range(node.children.iter().flatten(), root.nodes.len(), &format!("{name}: its child"))?;
    in_range(&node.mesh, root.meshes.len(), &format!("{name}: its mesh"))?;
    in_range(&node.skin, root.skins.len(), &format!("{name}: its skin"))
}

fn validate_primitive(root: &Root, primitive: &Primitive, name: &str) -> Result<(), FileError> {
    let accessors = root.accessors.len();
    in_range(primitive.attributes.values(), accessors, &format!("{name}: the accessor of an attribute"))?;
    in_range(&primitive.indices, accessors, &format!("{name}: the accessor of its indices"))?;
    in_range(&primitive.material, root.materials.len(), &format!("{name}: its material"))?;
    let targets = primitive.targets.iter().flatten();
    let targets = targets.flat_map(|target| target.positions.iter().chain(&target.normals).chain(&target.tangents));
    in_range(targets, accessors, &format!("{name}: the accessor of a morph target"))?;
    known(&primitive.mode, &format!("{name}: its mode"))
}

fn validate_accessor(root: &Root, accessor: &Accessor, name: &str) -> Result<(), FileError> {
    known(&accessor.component_type, &format!("{name}: its component type"))?;
    known(&accessor.type_, &format!("{name}: its type"))?;
    let views = root.buffer_views.len();
    in_range(&accessor.buffer_view, views, &format!("{name}: its buffer view"))?;
    if let Some(sparse) = &accessor.sparse {
        known(&sparse.indices.component_type, &format!("{name}: the type of its sparse indices"))?;
        let sparse = [&sparse.indices.buffer_view, &sparse.values.buffer_view];
        in_range(sparse, views, &format!("{name}: the buffer view of its sparse elements"))?;
    }
    Ok(())
}

/// Checks that indices are below `count`.
fn in_range<'a, T: 'a>(
    indices: impl IntoIterator<Item = &'a Index<T>>,
    count: usize,
    what: &str,
) -> Result<(), FileError> {
    match indices.into_iter().map(Index::value).find(|index| *index >= count) {
        Some(index) => Err(FileError::whole(format!("{what} is number {index}, and the file has {count}"))),
        None => Ok(()),
    }
}

fn known<T>(checked: &Checked<T>, what: &str) -> Result<(), FileError> {
    match checked {
        Checked::Valid(_) => Ok(()),
        Checked::Invalid => Err(FileError::whole(format!("{what} is unknown or missing"))),
    }
}
