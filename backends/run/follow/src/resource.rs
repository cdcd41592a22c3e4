//! The buffers and textures of a manifest.

use serde::Deserialize;

/// A buffer or a texture.
#[derive(Clone, Deserialize)]
pub struct Resource {
    /// Its name.
    pub name: String,
    /// `{"clear": word}`, `keep` or `external`.
    pub init: serde_json::Value,
    /// A formula for its 32-bit words.
    pub words: String,
    /// A formula for its bytes, at least `least_bytes`.
    pub bytes: String,
    /// Of a buffer.
    pub least_bytes: Option<u64>,
    /// Of a texture.
    pub texture: Option<Texture>,
}

/// What a texture has beside its words.
#[derive(Clone, Deserialize)]
pub struct Texture {
    /// Its format, as WebGPU names it.
    pub format: String,
    /// A formula for its samples per pixel.
    pub samples: String,
    /// Of a texture of the description: its name there.
    pub described: Option<String>,
    /// Of a texture of the description: its dimension.
    pub view_dimension: Option<ViewDimension>,
}

/// The dimension of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum ViewDimension {
    /// Columns and rows.
    #[serde(rename = "2d")]
    D2,
    /// Columns, rows and slices.
    #[serde(rename = "3d")]
    D3,
}

impl Resource {
    /// Returns the name that the description gives to a texture, and its dimension; `None`: it is another resource.
    pub fn described(&self) -> Option<(&str, ViewDimension)> {
        let texture = self.texture.as_ref()?;
        Some((texture.described.as_deref()?, texture.view_dimension?))
    }
}
