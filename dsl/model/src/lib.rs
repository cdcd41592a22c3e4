//! The model of a fragment buffer: the user's description ([`Draft`]), the checked description ([`Variant`]), and the
//! errors in it ([`Diagnostic`]). Front ends (file, macro, builder) make drafts; only [`check`] makes variants.
//!
//! This crate does not parse, does not write WGSL, does not depend on naga or wgpu, and names no technique.

mod attribute;
mod check;
mod diagnostic;
mod draft;
mod names;
mod nearest_name;
pub mod resumable;
mod set;
mod span;
mod texture;
mod uniform;
mod uniform_block;
mod user_row;
mod variant;

pub use attribute::{Attribute, AttributeSource};
pub use check::{MAX_K, check};
pub use diagnostic::{Code, Diagnostic, Diagnostics, Label, Severity, codes, counted};
pub use draft::{
    Alternative, Choice, Draft, Format, Incomplete, Keep, KeepCount, OptionValue, Reads, Suspicious, Unused,
    UserFunction,
};
pub use names::mangled;
pub use nearest_name::nearest_name;
pub use resumable::Resumable;
pub use set::SET;
pub use span::{SourceSpan, Spanned};
pub use texture::{Image, Texture, TextureDimension, image_resource};
pub use uniform::{Uniform, UniformType};
pub use uniform_block::UniformBlock;
pub use user_row::{RowSpans, UserRow};
pub use variant::{AxisChoice, Description, MissingFeature, SelectedRow, Selection, Variant};
