//! Runs plans on wgpu. The caller owns the device, the queue, the encoder and the draws; the plan gives the passes.
//!
//! ```text
//! Program ─► Shaders ─┐
//! Settings ───────────┴─► Renderer ──begin──► Frame ──record──► commands in the caller's encoder
//!                                               ▲                 │ suspended: the host must read
//!                                               └──resume── SuspendedFrame ◄─┘
//! ```
//!
//! `examples/embed.rs` is a host that owns its device and the order of its passes. In module form the caller's own pipelines
//! draw the scene ([`Renderer::geometry_passes`]). [`Renderer::render`] renders whole frames
//! where blocking is possible. Frames beyond a device limit or the memory budget
//! ([`Settings::memory`]) are drawn in slices ([`Settings::slice`]). A k beyond the capacity
//! of the pipelines needs other pipelines ([`Buckets`]).
//!
//! This crate contains no technique's name. Only [`Renderer::render`], [`block_on`] and [`headless`] block. Failures are
//! values of [`Error`]; a failed call changes nothing.

mod attachments;
mod bind_groups;
mod blocking;
mod buckets;
mod conditional;
mod draw;
mod draws;
mod error;
mod error_scope;
mod external;
mod fixed_function;
mod frame;
mod frame_blocks;
mod frame_resources;
mod geometry_pass;
pub mod headless;
mod lagged;
mod layout;
mod limits;
mod memory;
mod memory_limits;
mod objects;
mod pattern;
mod pipeline;
mod pipelines;
mod placeholder;
mod queries;
mod readback;
mod recording;
mod renderer;
mod results;
mod samples;
mod scene;
mod segment;
mod settings;
mod shaders;
mod texture;
mod timing;
mod uniform_buffers;
mod unsupported;
mod vertices;
mod words;

pub use blocking::block_on;
pub use buckets::Buckets;
pub use draw::{Call, Draw, Output};
pub use draws::{DrawArguments, SceneDraw};
pub use error::Error;
pub use fragbuf_frame::{
    Conditions, Counter, Counters, DEFAULT_MEMORY, Decisions, LaggedValues, LoopEnd, LoopReport, MemoryNeed, PassTime,
    PoolSize, Sizing, Value,
};
pub use frame::{Frame, Recorded, SuspendedFrame};
pub use geometry_pass::{GeometryPass, ModuleFunction};
pub use objects::ObjectBox;
pub use pipelines::Pipelines;
pub use readback::Pending;
pub use renderer::Renderer;
pub use settings::{Checks, Interlock, Settings, VertexBuffer};
pub use shaders::{Code, Module, Shaders};
pub use vertices::{VertexInput, VertexInputs};

/// The wgpu that devices, encoders and passes must come from.
pub use wgpu;
