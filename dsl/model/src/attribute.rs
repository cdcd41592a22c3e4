//! An attribute of the payload, and where passes in program form get its value: from vertices or from the rasteriser.

use crate::{Format, Spanned};

/// One attribute of the payload.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// The name as the user wrote it.
    pub name: Spanned<String>,
    /// Its storage format.
    pub format: Spanned<Format>,
}

/// Where passes that draw get the value of an attribute in program form. In module form, the caller's material gives all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AttributeSource {
    /// `depth: f32`: the depth of the fragment, from the rasteriser.
    Depth,
    /// `front: u32`: 1 if the front side of the triangle is visible, whose corners are then counter-clockwise in the image, else 0. From
    /// the rasteriser.
    FrontFacing,
    /// An input of the vertex stage.
    Vertex,
}

impl Attribute {
    /// Returns where the value comes from.
    pub fn source(&self) -> AttributeSource {
        match (self.name.value.as_str(), self.format.value) {
            ("depth", _) => AttributeSource::Depth,
            ("front", Format::U32) => AttributeSource::FrontFacing,
            _ => AttributeSource::Vertex,
        }
    }

    /// Returns whether the value is an input of the vertex stage.
    pub fn is_vertex_input(&self) -> bool {
        self.source() == AttributeSource::Vertex
    }
}
