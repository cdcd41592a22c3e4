//! Runs a group of invocations at once: each instruction is decoded once for all lanes of the group.
//!
//! Input: a program, and the inputs of up to [`LANES`] invocations. Output: which of them ended, and their results. Every word of the
//! machine is a word per lane. Lanes that take different branches run one after the other and meet again behind the branch (`flow`).
//! An access of several lanes takes effect lane by lane, in ascending order. A program of too many words has no lane machine: the caller runs
//! a [`Machine`](crate::Machine) per invocation.

#![allow(
    clippy::needless_range_loop,
    reason = "a loop over the lanes of several words, which becomes vector instructions"
)]

mod arithmetic;
mod flow;
mod machine;
mod memory;
mod program;
mod set;
mod shared;
mod workgroup;

pub use machine::LaneMachine;
pub use memory::LaneMemory;
pub(crate) use program::LaneProgram;
pub use set::{LANES, LaneSet};
pub use workgroup::LaneWorkgroup;
