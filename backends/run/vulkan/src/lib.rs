//! A host for Vulkan 1.1 and later: it runs generated SPIR-V passes and knows nothing but their manifest.
//!
//! Input: `manifest.json`, the files that it names, a scene. Output: the image, the words of any buffer, the
//! counters. Apart from `output` and `counters`, it contains no name of a technique, a resource or a pass, so it runs
//! whatever the description says. The crate `fragbuf-follow` parses the manifest and walks through its steps. Here
//! `context` opens Vulkan, `requirements` compares a device with the manifest, `gpu` creates the logical device,
//! `memory` creates buffers and textures, `shaders`, `attachments` and `pipeline` create what passes need, `access`
//! decides which barriers are needed, `engine` and `draw` record the steps, and `host` is what a caller uses.
#![allow(unsafe_code, reason = "every call of Vulkan is unsafe")]

mod access;
mod attachments;
mod bindings;
mod context;
mod copies;
mod draw;
mod engine;
mod gpu;
mod host;
mod memory;
mod names;
mod pipeline;
mod queries;
mod recorder;
mod requirements;
mod shaders;

pub use context::{Context, Settings, Validation};
pub use fragbuf_follow::manifest::{Plan, VertexInput};
pub use fragbuf_follow::{Error, Image, Object, Scene, Texels};
pub use host::Host;

/// The target whose files this host runs.
const TARGET: &str = "spirv";

/// The target that the caller supplies: the image.
const OUTPUT: &str = "output";
