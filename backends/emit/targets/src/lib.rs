//! Linked WGSL becomes files that other tools accept: WGSL, GLSL in two dialects, SPIR-V, HLSL and MSL, with a manifest.
//!
//! ```text
//! Program ──check──► Checked (naga's module and proof) ──target──► File… ──► manifest
//! ```
//!
//! [`check`] is the only caller of naga's front end, and [`Checked`] the proof that naga took the text. Targets never
//! read WGSL for its meaning and never replace strings in naga's output.

mod check;
mod generate;
mod glsl;
mod hlsl;
mod manifest;
mod markers;
mod msl;
mod spirv;
mod target;
mod wgsl;

pub use check::{Checked, check};
pub use generate::{Generation, Planned, Request, generate};
pub use manifest::{SCHEMA, manifest, plan_json};
pub use target::{Emission, File, Guards, TARGETS, TIERS, Target, target, tier};
