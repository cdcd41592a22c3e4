//! The types of the closure language: what each is called in Rust, in WGSL and in a message.
//!
//! In: words of the user's text and formats of the model. Out: [`Type`]. Nothing here infers or converts.

use fragbuf_model::{Format, UniformType};

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
    /// All uniforms; module scope in WGSL, so never a value there.
    Uniforms,
    /// The whole sorted list; functions in WGSL, so never a value there.
    Fragments,
    /// `()`
    Unit,
    /// What never ends normally: `return`, `break`, `continue`.
    Never,
    /// What a mistake left; agrees with everything, so one mistake is told once.
    Error,
    /// A number whose type the rest of the function decides; an index into [`crate::infer::Inference`].
    Unknown(usize),
}

impl Type {
    /// The type of this Rust name.
    pub(crate) fn from_rust(name: &str) -> Option<Type> {
        Self::NAMED.iter().find(|(word, _)| *word == name).map(|(_, kind)| *kind)
    }

    /// Every type that a user can write.
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

    /// What a closure sees of an attribute.
    pub(crate) fn of_attribute(format: Format) -> Type {
        match format {
            Format::F32 => Type::F32,
            Format::U32 => Type::U32,
            Format::Vec2 => Type::Vector(2),
            Format::Vec3 | Format::Octahedral => Type::Vector(3),
            Format::Vec4 | Format::Rgba8 | Format::Rgba16 => Type::Vector(4),
        }
    }

    /// What a closure sees of a uniform.
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

    /// The type as Rust spells it, for messages.
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
            Type::Fragments => "the list of fragments",
            Type::Unit => "()",
            Type::Never => "!",
            Type::Error => "a mistake",
            Type::Unknown(_) => "a number",
        }
    }

    /// The type as WGSL spells it. Types that WGSL has no values of never reach the printer.
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
            Type::Uniforms | Type::Fragments | Type::Unit | Type::Never | Type::Error => "u32",
        }
    }

    /// Whether it is a whole number of known type.
    pub(crate) fn is_integer(self) -> bool {
        matches!(self, Type::U32 | Type::I32 | Type::Usize)
    }

    /// Whether a variable can hold it in WGSL.
    pub(crate) fn is_value(self) -> bool {
        !matches!(self, Type::Uniforms | Type::Fragments | Type::Unit | Type::Never)
    }
}
