//! What every host that follows a manifest needs, without a graphics API.
//!
//! Input: the text of `manifest.json`. Output: the plan of a target as types (`manifest`, `pass`), which `check` has
//! checked, the values of formulas and symbols (`formula`, `values`), the bytes of uniform blocks (`uniforms`),
//! workgroups (`groups`), the results of host functions (`functions`), boxes of objects (`objects`), and the steps of
//! a frame in their order (`walk`), which a device of the host carries out. `panes` is the scene of the hosts'
//! programs. Apart from `output` and `counters`, it contains no name of a technique, a resource or a pass.

mod check;
pub mod formula;
mod functions;
mod groups;
pub mod manifest;
mod objects;
pub mod panes;
mod pass;
mod resource;
#[cfg(test)]
mod tests;
mod texels;
mod uniforms;
mod values;
mod walk;

use std::fmt;

pub use objects::{BOX, Image, Object, Scene};
pub use texels::{MOST_TEXELS, Texels};
pub use uniforms::Uniforms;
pub use values::Values;
pub use walk::{Call, Device, Walk};

/// An error: a message for people.
#[derive(Debug)]
pub struct Error(pub String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}
