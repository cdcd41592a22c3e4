//! Runs plans on wgpu. The caller owns device, queue, encoder and draws; the plan says what is done with them.
//!
//! ```text
//! Program ─► Shaders ─┐
//! Settings ───────────┴─► Renderer ──begin──► Frame ──record──► commands in the caller's encoder
//!                                               ▲                 │ cut: the host must read
//!                                               └──resume── Cut ◄─┘
//! ```
//!
//! `examples/embed.rs` is a host that owns its device and the order of its passes. Whole frames, where blocking is
//! possible, are [`Renderer::render`]. Frames beyond a limit are made of slices ([`Settings::slice`]); a k beyond the
//! capacity of the pipelines takes others ([`Buckets`]).
//!
//! Nothing here knows a technique by name, and nothing blocks, apart from [`Renderer::render`], [`block_on`] and
//! [`headless`]. Failures are values of [`Error`]; what failed has changed nothing.

mod attachments;
mod blocking;
mod blocks;
mod brought;
mod buckets;
mod error;
mod fixed_function;
mod frame;
pub mod headless;
mod layout;
mod memory;
mod objects;
mod pattern;
mod pipeline;
mod pipelines;
mod queries;
mod readback;
mod refusals;
mod renderer;
mod results;
mod room;
mod scope;
mod settings;
mod shaders;
mod sized;
mod texture;
mod timing;
mod vertices;
mod walk;
mod words;

pub use blocking::block_on;
pub use buckets::Buckets;
pub use error::Error;
pub use fragbuf_frame::{Counter, Counters, LoopEnd, Looped, PassTime, Room, Sizing, Value};
pub use frame::{Call, Cut, Draw, Frame, Output, Recorded};
pub use objects::ObjectBox;
pub use pipelines::Pipelines;
pub use readback::Pending;
pub use renderer::Renderer;
pub use settings::{Checks, Interlock, Settings, VertexBuffer};
pub use shaders::{Code, Module, Shaders};
pub use vertices::{VertexInput, VertexInputs};

/// The wgpu that devices, encoders and passes must come from.
pub use wgpu;
