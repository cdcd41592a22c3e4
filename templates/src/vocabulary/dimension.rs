//! Dimensions of textures of a description.

/// The dimension of a texture: four float channels per texel, one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureDimension {
    /// Columns and rows.
    D2,
    /// Columns, rows and slices.
    D3,
}

impl TextureDimension {
    /// Every dimension, in the order in which the documentation lists them.
    pub const ALL: [TextureDimension; 2] = [TextureDimension::D2, TextureDimension::D3];

    /// Returns the keyword of the language.
    pub fn keyword(self) -> &'static str {
        match self {
            TextureDimension::D2 => "2d",
            TextureDimension::D3 => "3d",
        }
    }

    /// Returns the number of coordinates of a texel.
    pub fn axes(self) -> usize {
        match self {
            TextureDimension::D2 => 2,
            TextureDimension::D3 => 3,
        }
    }
}
