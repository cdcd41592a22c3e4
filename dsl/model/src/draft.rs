//! A description as the user gave it: every part where it was written, nothing checked but its types.
//!
//! The three doors of the language (file, macro, builder) each make a [`Draft`]; equal descriptions make equal drafts.
//! User closures arrive here already type-checked and lowered to WGSL, because all doors share one type checker.

use crate::{Origin, Spanned};

/// One described fragment buffer, unchecked.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The buffer's name, an UpperCamel identifier.
    pub name: Spanned<String>,
    /// The technique whose choices this description starts from (`from kplus_array`).
    pub preset: Option<Spanned<String>>,
    /// What a fragment carries, in the user's order. Empty: the papers' payload, `color: rgba8, depth: f32`.
    pub attributes: Vec<Attribute>,
    /// Values the closures read that are the same for a whole pass.
    pub uniforms: Vec<Uniform>,
    /// How many fragments stay per pixel, and which are worst. Absent: the preset's.
    pub keep: Option<Keep>,
    /// A fragment enters iff all of these return true.
    pub constraints: Vec<UserFunction>,
    /// `axis: value else value`, in the user's order.
    pub choices: Vec<Choice>,
    /// What is made of the kept fragments, as a closure. A named effect is a choice on the axis `resolve`.
    pub resolve: Option<UserFunction>,
    /// Helper functions that closures call, in the user's order.
    pub helpers: Vec<UserFunction>,
}

impl Draft {
    /// A draft that says its name and nothing else.
    pub fn empty(name: Spanned<String>) -> Self {
        Draft {
            name,
            preset: None,
            attributes: Vec::new(),
            uniforms: Vec::new(),
            keep: None,
            constraints: Vec::new(),
            choices: Vec::new(),
            resolve: None,
            helpers: Vec::new(),
        }
    }
}

/// One attribute of the payload.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// The name as the user wrote it.
    pub name: Spanned<String>,
    /// How it is stored.
    pub format: Spanned<Format>,
}

/// How an attribute is stored, and so what a closure sees of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// 1 word; a closure sees `f32`.
    F32,
    /// 1 word; a closure sees `u32`.
    U32,
    /// 2 words; a closure sees `Vec2`.
    Vec2,
    /// 3 words; a closure sees `Vec3`.
    Vec3,
    /// 4 words; a closure sees `Vec4`.
    Vec4,
    /// 1 word: four channels of 8 bits in [0, 1], rounded to nearest (error ≤ 1/510); a closure sees `Vec4`.
    Rgba8,
    /// 2 words: four channels of 16 bits in [0, 1], rounded to nearest (error ≤ 1/131,070); a closure sees `Vec4`.
    Rgba16,
    /// 1 word: a unit vector as two 16-bit octahedral coordinates (Cigolle et al. 2014); a closure sees `Vec3`.
    Octahedral,
}

impl Format {
    /// Every format, in the order in which the documentation lists them.
    pub const ALL: [Format; 8] = [
        Format::F32,
        Format::U32,
        Format::Vec2,
        Format::Vec3,
        Format::Vec4,
        Format::Rgba8,
        Format::Rgba16,
        Format::Octahedral,
    ];

    /// The word of the language.
    pub fn keyword(self) -> &'static str {
        match self {
            Format::F32 => "f32",
            Format::U32 => "u32",
            Format::Vec2 => "vec2",
            Format::Vec3 => "vec3",
            Format::Vec4 => "vec4",
            Format::Rgba8 => "rgba8",
            Format::Rgba16 => "rgba16",
            Format::Octahedral => "octahedral",
        }
    }

    /// 32-bit words in memory.
    pub fn words(self) -> u32 {
        match self {
            Format::F32 | Format::U32 | Format::Rgba8 | Format::Octahedral => 1,
            Format::Vec2 | Format::Rgba16 => 2,
            Format::Vec3 => 3,
            Format::Vec4 => 4,
        }
    }

    /// The WGSL type that a shader and a closure see.
    pub fn wgsl_type(self) -> &'static str {
        match self {
            Format::F32 => "f32",
            Format::U32 => "u32",
            Format::Vec2 => "vec2<f32>",
            Format::Vec3 | Format::Octahedral => "vec3<f32>",
            Format::Vec4 | Format::Rgba8 | Format::Rgba16 => "vec4<f32>",
        }
    }
}

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

    /// The word of the language.
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

    /// The WGSL type.
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

/// The `keep` line.
#[derive(Clone, Debug, PartialEq)]
pub struct Keep {
    /// How many.
    pub count: Spanned<KeepCount>,
    /// h(f) of K15 §3.2.2: the fragment with the greatest value is the worst. Absent: depth.
    pub criterion: Option<UserFunction>,
}

/// How many fragments a pixel keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepCount {
    /// Every one: an A-buffer.
    All,
    /// The k best: a k-buffer.
    AtMost(u32),
}

impl From<u32> for KeepCount {
    fn from(count: u32) -> Self {
        KeepCount::AtMost(count)
    }
}

/// `axis: value { options } else value { options }`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The axis, a word of the registry.
    pub axis: Spanned<String>,
    /// At least one; the first that a target can express is taken there.
    pub alternatives: Vec<Alternative>,
}

impl Choice {
    /// Whether it only sets options of a value that it leaves to the preset (`--set sync.limit=9`).
    pub fn only_options(&self) -> bool {
        self.alternatives.iter().all(|alternative| alternative.value.value.is_empty())
    }
}

/// One value on an axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alternative {
    /// The value, a word of the registry; empty where only options are set.
    pub value: Spanned<String>,
    /// `{ name: value, … }` in the user's order.
    pub options: Vec<(Spanned<String>, Spanned<OptionValue>)>,
}

/// The value of an option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OptionValue {
    /// A whole number.
    Number(u32),
    /// A word.
    Word(String),
}

impl From<u32> for OptionValue {
    fn from(number: u32) -> Self {
        OptionValue::Number(number)
    }
}

impl From<&str> for OptionValue {
    fn from(word: &str) -> Self {
        OptionValue::Word(word.to_owned())
    }
}

/// A closure or helper function of the user's, type-checked and lowered to WGSL.
#[derive(Clone, Debug)]
pub struct UserFunction {
    /// Its name in WGSL: `user_criterion`, `user_admit_0`, `user_resolve`, `user_<helper>`.
    pub name: String,
    /// Where it begins.
    pub origin: Origin,
    /// The user's text, tokens separated by single spaces.
    pub rust: String,
    /// The whole WGSL function, ending in a newline.
    pub wgsl: String,
    /// Where each line of `wgsl` comes from; as many as `wgsl` has lines.
    pub lines: Vec<Origin>,
    /// What it reads.
    pub reads: Reads,
}

impl PartialEq for UserFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.wgsl == other.wgsl && self.reads == other.reads
    }
}

/// What a user function reads, helpers included. Names are the user's, each once, in order of first use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// Attributes of fragments.
    pub attributes: Vec<String>,
    /// Uniforms.
    pub uniforms: Vec<String>,
}
