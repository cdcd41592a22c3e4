//! A description as the user wrote it: every part with its span. Only the types of closures are checked.
//!
//! Each front end of the language (file, macro, builder) makes a [`Draft`]; equal descriptions make equal drafts. User
//! closures are already type-checked and lowered to WGSL, because all front ends share one type checker.

use crate::attribute::Attribute;
use crate::resumable::{Resumable, Uninterruptible};
use crate::{Diagnostics, Image, SourceSpan, Spanned, Texture, Uniform};

/// The description of one fragment buffer, unchecked.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The buffer's name, an UpperCamel identifier.
    pub name: Spanned<String>,
    /// The technique whose choices are the defaults (`from kplus_array`).
    pub preset: Option<Spanned<String>>,
    /// The payload, in the user's order. Empty: the papers' payload, `color: rgba8, depth: f32`.
    pub attributes: Vec<Attribute>,
    /// Values that closures read, constant during a pass.
    pub uniforms: Vec<Uniform>,
    /// Textures that closures read, supplied by the caller.
    pub textures: Vec<Texture>,
    /// The number of kept fragments per pixel, and the criterion. Absent: the preset's.
    pub keep: Option<Keep>,
    /// A fragment is admitted iff all of these return true.
    pub constraints: Vec<UserFunction>,
    /// `axis: value else value`, in the user's order.
    pub choices: Vec<Choice>,
    /// The effect, as a closure over the kept fragments. A named effect is a choice on the axis `resolve`.
    pub resolve: Option<UserFunction>,
    /// The effect, as a closure over two neighbouring fragments.
    pub between: Option<UserFunction>,
    /// Images that are computed before the effect, in the user's order.
    pub images: Vec<Image>,
    /// Helper functions that closures call, in the user's order.
    pub helpers: Vec<UserFunction>,
    /// Names that no closure uses, in the order of the source.
    pub unused: Vec<Spanned<Unused>>,
    /// The span of the closure of the effect, which `resolve` lacks if it has errors.
    pub effect: Option<Spanned<()>>,
    /// Calls in closures that are valid and do not compute what their names say.
    pub suspicious: Vec<Spanned<Suspicious>>,
    /// Warnings about the user files that the draft names.
    pub file_warnings: Diagnostics,
    /// The parts that the source has and the draft lacks, because they have errors.
    pub incomplete: Incomplete,
}

/// Which parts of a draft lack something that the source has. The rules report no absence of a part that is incomplete, because the error
/// in the source is its reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Incomplete {
    /// The preset.
    pub preset: bool,
    /// The payload.
    pub attributes: bool,
    /// The uniforms, textures or images.
    pub uniforms: bool,
    /// The number of kept fragments, or the criterion.
    pub keep: bool,
    /// The choices.
    pub choices: bool,
    /// The effect.
    pub resolve: bool,
    /// The helper functions.
    pub helpers: bool,
}

impl Incomplete {
    /// Every part: an item is not recognised.
    pub const ALL: Incomplete = Incomplete {
        preset: false,
        attributes: true,
        uniforms: true,
        keep: true,
        choices: true,
        resolve: true,
        helpers: true,
    };

    /// Returns the parts that are incomplete in either.
    pub fn or(self, other: Incomplete) -> Incomplete {
        Incomplete {
            preset: self.preset || other.preset,
            attributes: self.attributes || other.attributes,
            uniforms: self.uniforms || other.uniforms,
            keep: self.keep || other.keep,
            choices: self.choices || other.choices,
            resolve: self.resolve || other.resolve,
            helpers: self.helpers || other.helpers,
        }
    }

    /// Whether a capability, or a condition on the description, may be missing only because a part is incomplete. An effect with errors
    /// counts as a closure.
    pub fn hides_capabilities(self) -> bool {
        self.preset || self.attributes || self.keep || self.choices
    }
}

/// A name that no closure uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unused {
    /// A helper function.
    Function(String),
    /// A variable of a closure or a function.
    Variable(String),
}

/// A call that is valid and does not compute what its names say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suspicious {
    /// What it computes.
    pub message: String,
    /// A fix.
    pub help: String,
}

impl Draft {
    /// Creates a draft that has only a name.
    pub fn empty(name: Spanned<String>) -> Self {
        Draft {
            name,
            preset: None,
            attributes: Vec::new(),
            uniforms: Vec::new(),
            textures: Vec::new(),
            keep: None,
            constraints: Vec::new(),
            choices: Vec::new(),
            resolve: None,
            between: None,
            images: Vec::new(),
            helpers: Vec::new(),
            unused: Vec::new(),
            effect: None,
            suspicious: Vec::new(),
            file_warnings: Diagnostics::new(),
            incomplete: Incomplete::default(),
        }
    }
}

/// The storage format of an attribute, which also determines its type in closures.
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

    /// Returns the keyword of the language.
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

    /// Returns what it stores.
    pub fn meaning(self) -> &'static str {
        match self {
            Format::F32 => "a float",
            Format::U32 => "an unsigned integer",
            Format::Vec2 => "two floats",
            Format::Vec3 => "three floats",
            Format::Vec4 => "four floats",
            Format::Rgba8 => "four channels of 8 bits in [0, 1], rounded to nearest (error ≤ 1/510)",
            Format::Rgba16 => "four channels of 16 bits in [0, 1], rounded to nearest (error ≤ 1/131,070)",
            Format::Octahedral => "a unit vector as two 16-bit octahedral coordinates (Cigolle et al. 2014)",
        }
    }

    /// Returns the number of 32-bit words in memory.
    pub fn words(self) -> u32 {
        match self {
            Format::F32 | Format::U32 | Format::Rgba8 | Format::Octahedral => 1,
            Format::Vec2 | Format::Rgba16 => 2,
            Format::Vec3 => 3,
            Format::Vec4 => 4,
        }
    }

    /// Returns the type in WGSL and in closures.
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

/// The `keep` line.
#[derive(Clone, Debug, PartialEq)]
pub struct Keep {
    /// The number of kept fragments.
    pub count: Spanned<KeepCount>,
    /// h(f) of K15 §3.2.2: the fragment with the greatest value is the worst. Absent: depth.
    pub criterion: Option<UserFunction>,
}

/// The number of fragments that a pixel keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepCount {
    /// All: an A-buffer.
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
    /// The key of the axis in the registry.
    pub axis: Spanned<String>,
    /// At least one; each target takes the first that it supports.
    pub alternatives: Vec<Alternative>,
}

impl Choice {
    /// Whether it only sets options of a value that the preset chooses (`--set sync.limit=9`).
    pub fn only_options(&self) -> bool {
        self.alternatives.iter().all(|alternative| alternative.value.value.is_empty())
    }
}

/// One value on an axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alternative {
    /// The key of the value in the registry; empty if only options are set.
    pub value: Spanned<String>,
    /// `{ name: value, … }` in the user's order.
    pub options: Vec<(Spanned<String>, Spanned<OptionValue>)>,
}

/// The value of an option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OptionValue {
    /// A whole number.
    Number(u32),
    /// A name.
    Name(String),
}

impl From<u32> for OptionValue {
    fn from(number: u32) -> Self {
        OptionValue::Number(number)
    }
}

impl From<&str> for OptionValue {
    fn from(name: &str) -> Self {
        OptionValue::Name(name.to_owned())
    }
}

/// A closure or helper function of the user, type-checked and lowered to WGSL.
#[derive(Clone, Debug)]
pub struct UserFunction {
    /// Its name in WGSL: `user_criterion`, `user_admit_0`, `user_resolve`, `user_between`, `user_image_<name>`, `user_<helper>`.
    pub name: String,
    /// The span of its first token.
    pub span: SourceSpan,
    /// The user's source, tokens separated by single spaces.
    pub rust: String,
    /// The whole WGSL function, ending in a newline.
    pub wgsl: String,
    /// The source span of each line of `wgsl`.
    pub lines: Vec<SourceSpan>,
    /// What it reads.
    pub reads: Reads,
    /// Of an effect: its parts, if it can be interrupted between two fragments.
    pub resumable: Option<Result<Box<Resumable>, Uninterruptible>>,
}

impl PartialEq for UserFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.wgsl == other.wgsl && self.reads == other.reads
    }
}

/// What a user function and its helpers read: the user's names, in order of first use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// Attributes of fragments.
    pub attributes: Vec<String>,
    /// Uniforms.
    pub uniforms: Vec<String>,
    /// Textures.
    pub textures: Vec<String>,
    /// Images.
    pub images: Vec<String>,
}
