//! Fragment buffers in Bevy.
//!
//! `passes` generates the passes of a description in portable WGSL. `follower` follows their manifest on the device of Bevy's render
//! world, without a name of a technique. `program` draws vertices with them, and `plugin` the transparent meshes of cameras. `headless`
//! opens Bevy without a window.

pub mod demo;
pub mod follower;
pub mod headless;
mod passes;
mod plugin;
mod program;

pub use follower::{Counters, Follower, Gpu, Output};
pub use fragbuf_follow::{Error, Object, Scene};
pub use passes::{Attribute, GROUP, PREFIX, Passes, TARGET};
pub use plugin::{FragmentBuffer, FragmentBufferPlugin, FragmentCounters};
pub use program::Vertices;
