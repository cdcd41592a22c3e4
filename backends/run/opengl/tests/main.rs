//! Generated GLSL on a real driver of OpenGL and OpenGL ES, in program and module form, at odd sizes and in permuted drawing orders: every
//! technique, every row of every axis, every k below the capacity. The image is that of a reference that shares no code with the
//! templates, or of the CPU device for techniques that state that they lose fragments.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by a panic")]

mod draw;
mod effects;
mod errors;
mod facing;
#[path = "../../../../tests/oracle/hosts.rs"]
mod hosts;
mod lookups;
mod material;
mod peeling;
mod peers;
mod pixels;
mod program;
mod targets;
