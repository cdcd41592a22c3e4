//! Uniforms: values that closures read, constant during a pass.

use crate::Spanned;

/// One value of the `uniform { }` block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uniform {
    /// The name as the user wrote it.
    pub name: Spanned<String>,
    /// Its type.
    pub kind: Spanned<UniformType>,
}

/// The types a uniform may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UniformType {
    /// `f32`
    F32,
    /// `u32`
    U32,
    /// `i32`
    I32,
    /// `vec2`
    Vec2,
    /// `vec3`
    Vec3,
    /// `vec4`
    Vec4,
}

impl UniformType {
    /// Every type, in the order in which the documentation lists them.
    pub const ALL: [UniformType; 6] =
        [UniformType::F32, UniformType::U32, UniformType::I32, UniformType::Vec2, UniformType::Vec3, UniformType::Vec4];

    /// Returns the keyword of the language.
    pub fn keyword(self) -> &'static str {
        match self {
            UniformType::F32 => "f32",
            UniformType::U32 => "u32",
            UniformType::I32 => "i32",
            UniformType::Vec2 => "vec2",
            UniformType::Vec3 => "vec3",
            UniformType::Vec4 => "vec4",
        }
    }

    /// Returns the number of its components.
    pub fn components(self) -> u32 {
        match self {
            UniformType::F32 | UniformType::U32 | UniformType::I32 => 1,
            UniformType::Vec2 => 2,
            UniformType::Vec3 => 3,
            UniformType::Vec4 => 4,
        }
    }

    /// Returns the WGSL type.
    pub fn wgsl_type(self) -> &'static str {
        match self {
            UniformType::F32 => "f32",
            UniformType::U32 => "u32",
            UniformType::I32 => "i32",
            UniformType::Vec2 => "vec2<f32>",
            UniformType::Vec3 => "vec3<f32>",
            UniformType::Vec4 => "vec4<f32>",
        }
    }
}
