//! The model of a fragment buffer: what a user described ([`Draft`]), what passed our rules ([`Variant`]), and what is
//! wrong with it ([`Diagnostic`]). Doors (file, macro, builder) make drafts; [`check`] is the only maker of variants.
//!
//! Nothing here parses text, writes WGSL, or knows naga, wgpu or a technique by name.

mod check;
mod diagnostic;
mod draft;
mod names;
mod origin;
mod own;
mod set;
mod uniform_block;
mod variant;

pub use check::{MOST_KEPT, check};
pub use diagnostic::{Code, Diagnostic, Diagnostics, Label, codes};
pub use draft::{
    Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, OptionValue, Reads, Uniform, UniformType,
    UserFunction,
};
pub use names::mangled;
pub use origin::{Origin, Spanned};
pub use own::{OwnRow, RowPlaces, written};
pub use uniform_block::UniformBlock;
pub use variant::{Chosen, Description, Refusal, Selected, Selection, Variant};
