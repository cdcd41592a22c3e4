//! What closures read beside fragments and uniforms: textures of the caller, and images that a frame computes first.

pub use fragbuf_templates::vocabulary::TextureDimension;

use crate::{Spanned, UserFunction};

/// A texture of the `texture { }` block. The caller supplies it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// The name as the user wrote it.
    pub name: Spanned<String>,
    /// Its dimension.
    pub dimension: Spanned<TextureDimension>,
}

impl Texture {
    /// Returns the name of the texture in plans, shaders and manifests. Rows have no such names.
    pub fn resource(&self) -> String {
        format!("texture_{}", self.name.value)
    }
}

/// `image name |fragments, u| …`: one value per pixel, computed before the effect, which can read it at other pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// The name as the user wrote it.
    pub name: Spanned<String>,
    /// The closure. It can read the images before it.
    pub function: UserFunction,
}

impl Image {
    /// Returns the name of the image in plans, shaders and manifests.
    pub fn resource(&self) -> String {
        image_resource(&self.name.value)
    }
}

/// Returns the name in plans, shaders and manifests of the image of this name.
pub fn image_resource(name: &str) -> String {
    format!("image_{name}")
}
