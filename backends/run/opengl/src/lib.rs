//! A host for OpenGL 4.5: it runs generated GLSL passes and knows nothing but their manifest.
//!
//! Input: `manifest.json`, the files that it names, a scene. Output: the image, the words of any buffer, the counters. It contains no name
//! of a technique, a resource or a pass, so it runs whatever the description says. `context` opens OpenGL without a window, `manifest`
//! parses, `formula` evaluates sizes, `memory` creates buffers and textures, `state` sets the fixed-function state of a pass, and
//! `frame` follows the steps of a frame. `compute` runs a single shader, for tests of printed GLSL.
#![allow(unsafe_code, reason = "every call of OpenGL is unsafe")]

mod compute;
mod context;
mod formula;
mod frame;
mod host;
mod manifest;
mod memory;
mod peer;
mod program;
mod state;
mod timing;

use std::fmt;

pub use context::Context;
pub use host::{Host, Image, Object, Scene};
pub use manifest::VertexInput;
pub use peer::{Description, Peer};
pub use timing::{Comparison, compare};

/// An error: a message for people.
#[derive(Debug)]
pub struct Error(pub String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}
