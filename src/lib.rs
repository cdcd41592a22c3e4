//! Generates complete GPU passes from one description of a per-pixel *fragment buffer*.
//!
//! A fragment buffer keeps several fragments per pixel: a k-buffer, an A-buffer, peeled layers. The description declares the
//! attributes of a fragment, how many fragments a pixel keeps and which one is worst. It also chooses where they are stored,
//! how writers of the same pixel are synchronised, and the effect:
//!
//! ```
//! # use fragbuf::{Registry, check, parse};
//! let text = "
//!     buffer Glass from kplus_array {
//!         fragment { color: rgba8, depth: f32, id: u32 }
//!         keep 4 least |f| f.depth - 0.25 * f.color.w;
//!     }";
//! let parsed = parse(text, "glass.fragbuf");
//! assert!(parsed.diagnostics.is_empty());
//! let variant = parsed.draft.and_then(|draft| check(&draft, &Registry::builtin()).ok());
//! assert_eq!(variant.map(|variant| variant.keep), Some(Some(4)));
//! ```
//!
//! [`generate`] then writes files for every target, and [`manifest`] specifies how an engine runs them.
//!
//! A description can also be written in Rust, as a module with structs and callable closures ([`fragment_buffer!`]), or built
//! by a program ([`builder`]).
//!
//! The [`guide`] covers all of this.
//!
//! This crate is the facade. It re-exports the stages and adds [`load`], which turns the key of a technique or the text of a
//! file into a variant with the rows of user files ([`user_file`]), and [`report`], which formats diagnostics with their
//! source lines. [`build`] generates inside a `build.rs`, [`snapshot`] inside tests.

#![allow(clippy::test_attr_in_doctest, reason = "the guide shows tests that readers write")]

pub mod analysis;
pub mod build;
pub mod guide;
pub mod load;
pub mod report;
pub mod snapshot;
pub mod source_file;
pub mod user_file;

pub use fragbuf_codegen::{Arrival, Form, GENERATOR, Linking, Plan, Profile, Program, link, plan};
pub use fragbuf_dsl::{
    CapturedTokens, Fragments, Image, Texture2d, Texture3d, UniformValue, builder, closure, function, glam,
};
pub use fragbuf_model::{
    Diagnostic, Diagnostics, Draft, Selection, Severity, SourceSpan, Texture, TextureDimension, Variant, check,
};
pub use fragbuf_syntax::{Parsed, parse};
pub use fragbuf_targets::{
    Binding, BindingKind, Checked, File, Generation, JSON_SCHEMA, Limit, Needed, OpenGlBindings, Request, Requirements,
    SCHEMA, SampleType, Sharing, TARGETS, TIERS, Target, WebGpuLimit, Workgroup, generate, limits, manifest, plan_json,
    requirements, select, target, tier, tier_meaning,
};
pub use fragbuf_templates::{Registry, vocabulary};

#[doc(hidden)]
pub use fragbuf_bindings as binding_macros;
#[doc(hidden)]
pub use fragbuf_dsl::{as_written, macros};

/// Describes a fragment buffer in Rust, with the grammar of `.fragbuf` files; a visibility and documentation may come first.
///
/// It emits a module named after the buffer (`MostVisible`: `most_visible`), as [`fragbuf_dsl::fragment_buffer!`] does:
///
/// * `Fragment` and `Uniforms`, the closures as functions, `draft()` and `variant()`;
///
/// and in addition
///
/// * `bindings`: the binding numbers of uniform blocks and buffers in the bind group, if they are the same on every target.
#[macro_export]
macro_rules! fragment_buffer {
    ($($description:tt)*) => { $crate::macros::fragment_buffer! { [$crate] $($description)* } };
}

/// Emits the module `bindings` of a description.
#[doc(hidden)]
#[macro_export]
macro_rules! bindings {
    ($($description:tt)*) => { $crate::binding_macros::bindings! { $($description)* } };
}
