//! fragbuf: one description of a per-pixel *fragment buffer* becomes complete GPU passes.
//!
//! A fragment buffer keeps more than one fragment per pixel: a k-buffer, an A-buffer, peeled layers. The description says
//! what a fragment carries, how many stay, which one is worst, where they are stored, how writers of the same pixel are
//! kept apart and what is made of them:
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
//! From there [`generate`] makes files for every target, and [`manifest`] says how an engine runs them.
//!
//! The same description can stand in Rust, as a module with structs and callable closures ([`fragment_buffer!`]), or be put
//! together by a program ([`builder`]).
//!
//! The [`guide`] goes through all of it.
//!
//! This crate is the facade: it re-exports the stages and adds [`load`], which turns a technique's key or a file's text
//! into a variant with the rows of the user's own files ([`own`]), and [`report`], which draws diagnostics with their
//! source lines. [`build`] generates inside a `build.rs`, [`snapshot`] inside tests.

#![allow(clippy::test_attr_in_doctest, reason = "the guide shows tests that readers write")]

pub mod build;
pub mod guide;
pub mod load;
pub mod own;
pub mod report;
pub mod snapshot;

pub use fragbuf_targets::{
    Checked, File, Generation, Request, SCHEMA, TARGETS, TIERS, Target, generate, manifest, plan_json, target, tier,
};
pub use fragbuf_codegen::{Arrival, Form, GENERATOR, Linking, Plan, Profile, Program, link, plan};
pub use fragbuf_dsl::{builder, closure, fragment_buffer, function, glam};
pub use fragbuf_model::{Diagnostic, Diagnostics, Draft, Origin, Selection, Variant, check};
pub use fragbuf_syntax::{Parsed, parse};
pub use fragbuf_templates::{Registry, vocabulary};
