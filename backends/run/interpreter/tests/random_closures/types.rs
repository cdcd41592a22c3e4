//! The types of generated closures, and the values that they read.

/// A type of the closure language that has values in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    U32,
    I32,
    Usize,
    F32,
    Bool,
    Vector(usize),
}

/// The uniforms that generated closures read.
pub const UNIFORMS: [(&str, Type); 8] = [
    ("a", Type::U32),
    ("b", Type::U32),
    ("i", Type::I32),
    ("j", Type::I32),
    ("x", Type::F32),
    ("y", Type::F32),
    ("p", Type::Vector(2)),
    ("q", Type::Vector(4)),
];

/// The attributes of fragments.
pub const ATTRIBUTES: [(&str, Type); 4] =
    [("depth", Type::F32), ("id", Type::U32), ("color", Type::Vector(4)), ("normal", Type::Vector(3))];

/// The greatest number of fragments.
pub const FRAGMENTS: usize = 3;

impl Type {
    /// Returns the name in Rust.
    pub fn rust(self) -> &'static str {
        match self {
            Type::U32 => "u32",
            Type::I32 => "i32",
            Type::Usize => "usize",
            Type::F32 => "f32",
            Type::Bool => "bool",
            Type::Vector(2) => "Vec2",
            Type::Vector(3) => "Vec3",
            Type::Vector(_) => "Vec4",
        }
    }

    /// Returns the type of a Rust name.
    pub fn named(name: &str) -> Option<Type> {
        let all = [Type::U32, Type::I32, Type::Usize, Type::F32, Type::Bool];
        all.into_iter().chain((2..=4).map(Type::Vector)).find(|ty| ty.rust() == name)
    }

    /// Returns the name in a list of attributes or uniforms.
    pub fn keyword(self) -> String {
        self.rust().to_lowercase()
    }

    /// Returns the type in WGSL.
    pub fn wgsl(self) -> String {
        match self {
            Type::Usize => "u32".to_owned(),
            Type::Vector(size) => format!("vec{size}<f32>"),
            other => other.rust().to_owned(),
        }
    }

    /// Returns the number of words.
    pub fn words(self) -> usize {
        match self {
            Type::Vector(size) => size,
            _ => 1,
        }
    }

    pub fn is_integer(self) -> bool {
        matches!(self, Type::U32 | Type::I32 | Type::Usize)
    }
}

/// Returns the number of words of all fields.
pub fn words_of(fields: &[(&str, Type)]) -> usize {
    fields.iter().map(|(_, ty)| ty.words()).sum()
}
