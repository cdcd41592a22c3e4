//! Runs naga's IR on the CPU: any compute or fragment entry point, or any single function, of a validated module.
//!
//! ```text
//! Module + ModuleInfo ──Program::entry_point──► Program ──Machine::new──► Machine ──run──► Exit
//!                                                 │ all calls inlined       │ flat words    ▲
//!                                                 └ a trace per instruction └──── Shared ───┘ every access to memory
//! ```
//!
//! A machine is one invocation: a place in the program and a row of words. What it shares with others it reaches through
//! [`Shared`] alone, which answers, or stops it there; so one loop serves running to the end, stepping from access to
//! access, and any model of memory. Nothing here knows fragbuf: what a shader has no word for is a [`Marker`] by name.
//!
//! WGSL's arithmetic is followed where it is defined (wrapping, division by zero, shifts, saturating conversions);
//! uninitialised memory is zero; an index out of bounds reads 0 or writes nothing, and is a [`Fault`]. Flat textures
//! are read texel by texel, single and multisampled; samplers, storage textures, layers and levels, derivatives, subgroups, ray queries, 16-bit and 64-bit floats are [`Unsupported`].

mod arithmetic;
mod compile;
mod live;
mod machine;
mod memory;
mod operation;
mod packing;
mod program;
mod scalar;
mod shape;
mod wide;
mod workgroup;

pub use machine::{Exit, Fault, Machine};
pub use memory::{Access, Atomic, Event, Operation, Place, Reply, Sequential, Shared};
pub use packing::{from_half, to_half};
pub use program::{Buffer, Input, Marker, Options, Program, Space, Texture, Unsupported};
pub use workgroup::{Dispatch, dispatch, workgroup};
