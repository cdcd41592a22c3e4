//! A host for OpenGL 4.5 and OpenGL ES 3.1: it runs generated GLSL passes and reads nothing but their manifest.
//!
//! Input: `manifest.json`, the files that it names, a scene, in module form a material. Output: the image, the words of
//! any buffer, the counters. Apart from `output` and `counters`, it contains no name of a technique, a resource or a
//! pass, so it runs whatever the description says; only indirect arguments, which no built-in technique has, are an
//! error. The crate `fragbuf-follow` parses the manifest, evaluates sizes and walks through the steps of a frame;
//! `device` carries them out, and `draw` runs a pass. `context` opens OpenGL without a window, `api` has the differences
//! of the two APIs, `limits` compares the manifest with the driver, `material` joins shaders of the caller with passes
//! in module form, `memory` creates buffers and textures, and `state` sets the fixed-function state of a pass. `compute`
//! runs a single shader, for tests of printed GLSL. The guide's chapter `opengl` explains how to follow a manifest with
//! these APIs.
#![allow(unsafe_code, reason = "every call of OpenGL is unsafe")]

mod api;
mod compute;
mod context;
mod device;
mod draw;
mod host;
mod limits;
mod material;
mod memory;
mod peer;
mod program;
mod state;
mod timing;

pub use api::Api;
pub use context::Context;
pub use fragbuf_follow::manifest::VertexInput;
pub use fragbuf_follow::{Error, Image, Object, Scene, Texels};
pub use host::Host;
pub use material::Material;
pub use peer::{Description, PROJECTS, Peer, Project};
pub use timing::{Comparison, WARM_UP, compare};
