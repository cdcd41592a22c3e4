//! Generated SPIR-V on a Vulkan driver with the validation layer, at odd sizes, in slices and in permuted drawing
//! orders: every technique, every row of every axis. The image is that of a reference that shares no code with the
//! templates, or of the CPU device for techniques that state that they lose fragments. A message of the validation
//! layer is a failure.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by a panic")]

mod drivers;
mod effects;
mod facing;
#[path = "../../../../tests/oracle/hosts.rs"]
mod hosts;
mod interlock;
mod lookups;
mod misuse;
mod peeling;
mod pixels;
mod program;
mod stage;
