//! Emits linked WGSL as WGSL, GLSL, SPIR-V, HLSL and MSL, with a manifest.
//!
//! ```text
//! Program ──check──► Checked (naga's module) ──target──► File… ──► manifest
//! ```
//!
//! [`check`] is the only caller of naga's WGSL parser, and [`Checked`] the proof that naga accepts the source. Emitters never
//! parse WGSL and never replace strings in naga's output.

mod bindings;
mod c_header;
mod check;
mod emission;
mod generate;
mod glsl;
mod hlsl;
mod limits;
mod manifest;
mod markers;
mod msl;
mod names;
mod opengl_bindings;
mod rejection;
mod requirements;
mod spirv;
mod target;
mod user_file_error;
mod wgsl;

pub use bindings::{Binding, BindingKind, SampleType};
pub use c_header::{c_header, c_name};
pub use check::{Checked, Rejection, causes, check, validate};
pub use emission::{Emission, File, Guards};
pub use generate::{Generation, PlanForTargets, Request, generate, select};
pub use limits::{Limit, Needed, Sharing, WebGpuLimit, Workgroup, limits};
pub use manifest::{JSON_SCHEMA, SCHEMA, manifest, plan_json};
pub use opengl_bindings::OpenGlBindings;
pub use rejection::{before_missing_semicolon, explained};
pub use requirements::{Requirements, requirements};
pub use target::{TARGETS, TIERS, Target, target, tier, tier_meaning};
