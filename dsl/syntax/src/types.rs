//! The types of the closure language, and their names in Rust, in WGSL and in messages.
//!
//! Input: type names of the user's source, and formats of the model. Output: [`Type`].

use fragbuf_model::{Format, TextureDimension, UniformType};

/// The type of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    F32,
    U32,
    I32,
    /// Rust's index type; `u32` in WGSL.
    Usize,
    Bool,
    /// `Vec2`, `Vec3`, `Vec4`.
    Vector(u8),
    /// One fragment.
    Fragment,
    /// All uniforms. They have module scope in WGSL, so they are never a value there.
    Uniforms,
    /// A texture or an image, which only methods read.
    Texture(Shape),
    /// The sorted list of fragments. WGSL accesses it by functions, so it is never a value there.
    Fragments,
    /// `()`
    Unit,
    /// The type of diverging expressions: `return`, `break`, `continue`.
    Never,
    /// The type of an invalid expression. It unifies with every type, so that an error is reported once.
    Error,
    /// A number whose type is inferred from its uses; an index into [`crate::infer::Inference`].
    Unknown(usize),
}

/// The shape of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A texture of the caller with columns and rows.
    D2,
    /// A texture of the caller with columns, rows and slices.
    D3,
    /// An image of the description, with a texel per pixel.
    Image,
}

impl Shape {
    /// Returns the shape of a texture of this dimension.
    pub(crate) fn of(dimension: TextureDimension) -> Self {
        match dimension {
            TextureDimension::D2 => Shape::D2,
            TextureDimension::D3 => Shape::D3,
        }
    }
}

impl Type {
    /// Returns the type of this Rust name.
    pub(crate) fn from_rust(name: &str) -> Option<Type> {
        Self::NAMED.iter().find(|(other, _)| *other == name).map(|(_, ty)| *ty)
    }

    /// The types that a user can write.
    pub(crate) const NAMED: [(&'static str, Type); 10] = [
        ("f32", Type::F32),
        ("u32", Type::U32),
        ("i32", Type::I32),
        ("usize", Type::Usize),
        ("bool", Type::Bool),
        ("Vec2", Type::Vector(2)),
        ("Vec3", Type::Vector(3)),
        ("Vec4", Type::Vector(4)),
        ("Fragment", Type::Fragment),
        ("Uniforms", Type::Uniforms),
    ];

    /// Returns the type of an attribute in a closure.
    pub(crate) fn of_attribute(format: Format) -> Type {
        match format {
            Format::F32 => Type::F32,
            Format::U32 => Type::U32,
            Format::Vec2 => Type::Vector(2),
            Format::Vec3 | Format::Octahedral => Type::Vector(3),
            Format::Vec4 | Format::Rgba8 | Format::Rgba16 => Type::Vector(4),
        }
    }

    /// Returns the type of a uniform in a closure.
    pub(crate) fn of_uniform(kind: UniformType) -> Type {
        match kind {
            UniformType::F32 => Type::F32,
            UniformType::U32 => Type::U32,
            UniformType::I32 => Type::I32,
            UniformType::Vec2 => Type::Vector(2),
            UniformType::Vec3 => Type::Vector(3),
            UniformType::Vec4 => Type::Vector(4),
        }
    }

    /// Returns the name in Rust, for messages.
    pub(crate) fn rust(self) -> &'static str {
        match self {
            Type::F32 => "f32",
            Type::U32 => "u32",
            Type::I32 => "i32",
            Type::Usize => "usize",
            Type::Bool => "bool",
            Type::Vector(2) => "Vec2",
            Type::Vector(3) => "Vec3",
            Type::Vector(_) => "Vec4",
            Type::Fragment => "Fragment",
            Type::Uniforms => "Uniforms",
            Type::Texture(Shape::D2) => "Texture2d",
            Type::Texture(Shape::D3) => "Texture3d",
            Type::Texture(Shape::Image) => "Image",
            Type::Fragments => "the list of fragments",
            Type::Unit => "()",
            Type::Never => "!",
            Type::Error => "an invalid type",
            Type::Unknown(_) => "a number",
        }
    }

    /// Returns the name in WGSL. Types without WGSL values never reach the printer.
    pub(crate) fn wgsl(self) -> &'static str {
        match self {
            Type::F32 | Type::Unknown(_) => "f32",
            Type::U32 | Type::Usize => "u32",
            Type::I32 => "i32",
            Type::Bool => "bool",
            Type::Vector(2) => "vec2<f32>",
            Type::Vector(3) => "vec3<f32>",
            Type::Vector(_) => "vec4<f32>",
            Type::Fragment => "Fragment",
            Type::Uniforms | Type::Texture(_) | Type::Fragments | Type::Unit | Type::Never | Type::Error => "u32",
        }
    }

    /// Returns whether this is a known integer type.
    pub(crate) fn is_integer(self) -> bool {
        matches!(self, Type::U32 | Type::I32 | Type::Usize)
    }

    /// Returns whether a WGSL variable can have this type.
    pub(crate) fn is_value(self) -> bool {
        !matches!(self, Type::Uniforms | Type::Texture(_) | Type::Fragments | Type::Unit | Type::Never)
    }
}
