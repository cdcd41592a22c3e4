//! What a model lacks, and what it has that is not read.

use std::borrow::Cow;

use gltf::json::{Root, Value, deserialize};
use gltf::{Document, Glb, Gltf, json};

use super::json::take;
use super::locate::Text;
use crate::error::FileError;
use crate::limits::Budget;
use crate::text::quoted;
use crate::warnings::{FileWarnings, Message, WarningKind};

/// Extensions that change the image and are not read, and what is drawn without them.
const EXTENSIONS: [(&str, &str); 3] = [
    ("EXT_mesh_gpu_instancing", "each node is drawn once"),
    ("KHR_materials_transmission", "a material has the alpha of its base colour"),
    ("KHR_node_visibility", "all nodes are drawn"),
];

/// Adds warnings about parts that change the image and are not read.
pub(super) fn warn(root: &Root, text: Text<'_>, warnings: FileWarnings<'_>) {
    let warn = |list: &str, number: usize, message: Message| {
        warnings.add(WarningKind::NotRead, list, || (text.position(list, number), message));
    };
    for (number, material) in root.materials.iter().enumerate() {
        let glossiness = material.extensions.as_ref().and_then(|all| all.pbr_specular_glossiness.as_ref());
        let base = &material.pbr_metallic_roughness.base_color_texture;
        if base.is_some() || glossiness.is_some_and(|glossiness| glossiness.diffuse_texture.is_some()) {
            let text = format!("material {number}: textures are not read");
            warn("materials", number, Message::new(text, "the factor of its base colour is used without them"));
        }
    }
    for (number, extension) in root.extensions_used.iter().enumerate() {
        if let Some((_, instead)) = EXTENSIONS.iter().find(|(name, _)| name == extension) {
            warnings.add(WarningKind::NotRead, extension, || {
                let message = Message::new(format!("`{extension}` is not read"), *instead);
                (text.position("extensionsUsed", number), message)
            });
        }
    }
    if let Some(number) = root.nodes.iter().position(|node| node.skin.is_some()) {
        warn(
            "nodes",
            number,
            Message::new(
                format!("node {number}: the joints of skins are not read"),
                "its mesh is drawn in its own pose",
            ),
        );
    }
}

/// Parses the JSON of a model in which a scene has no `nodes`, which the format allows and the `gltf` crate does not. `None`: this is not
/// the reason of the error. `Err`: the model has another version.
pub(super) fn repaired(bytes: &[u8], error: &json::Error, budget: &Budget) -> Result<Option<Gltf>, FileError> {
    if !error.is_data() {
        return Ok(None);
    }
    // The JSON is parsed once more, and the parsed value exists beside the result.
    take(bytes, budget)?;
    let (json, blob) = match bytes.starts_with(b"glTF").then(|| Glb::from_slice(bytes).ok()).flatten() {
        Some(glb) => (glb.json, glb.bin.map(Cow::into_owned)),
        None => (bytes.into(), None),
    };
    let Ok(mut value) = deserialize::from_slice::<Value>(&json) else { return Ok(None) };
    let version = value.pointer("/asset/version").and_then(Value::as_str);
    if let Some(version) = version.filter(|version| !version.starts_with("2.")) {
        return Err(unsupported_version(version));
    }
    for scene in value.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut().filter(|scene| !scene.contains_key("nodes")) {
            scene.insert("nodes".to_owned(), Value::Array(Vec::new()));
        }
    }
    let root = deserialize::from_value(value).ok();
    Ok(root.map(|root| Gltf { document: Document::from_json_without_validation(root), blob }))
}

/// Returns the error about a version.
pub(super) fn unsupported_version(version: &str) -> FileError {
    FileError::whole(format!("glTF version {}: version 2 is read", quoted(version))).in_element("asset", 0)
}
