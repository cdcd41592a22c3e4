//! Runs naga's IR on the CPU: any entry point or single function of a validated module.
//!
//! ```text
//! Module + ModuleInfo ──Bytecode::entry_point──► Bytecode ──Machine::new──► Machine ──run──► Exit
//!                                                 │ calls inlined            ▲
//!                                                 └ spans per instruction    └─ SharedMemory: every memory access
//! ```
//!
//! A machine is one invocation: an instruction index and an array of words. It accesses shared memory only through
//! [`SharedMemory`]. Each access returns a value or stops the machine, so one loop serves complete runs, single steps from
//! access to access, and every memory model. A [`LaneMachine`] is a group of invocations whose accesses take effect at once. This crate is
//! independent of fragbuf: a function that stands for a construct that WGSL lacks is a [`Marker`] by name.
//!
//! Arithmetic follows WGSL where WGSL defines it (wrapping, division by zero, shifts, saturating conversions).
//! Uninitialised memory is zero. An index out of bounds reads 0 or writes nothing, and is an [`OutOfBoundsAccess`].
//! 2D and 3D textures are read texel by texel, single and multisampled. Samplers, storage textures, layers, levels, derivatives,
//! subgroups, ray queries, 16-bit numbers and 64-bit floats are [`Unsupported`].

mod arithmetic;
mod bytecode;
mod compile;
mod half;
mod lanes;
mod layout;
mod live;
mod machine;
mod memory;
mod operation;
mod packing;
mod retry;
mod scalar;
mod wide;
mod workgroup;

pub use bytecode::{Buffer, Bytecode, InterfaceVariable, Marker, Options, Space, Texture, Unsupported};
pub use half::{from_half, to_half};
pub use lanes::{LANES, LaneMachine, LaneMemory, LaneSet, LaneWorkgroup};
pub use machine::{Exit, Machine, OutOfBoundsAccess};
pub use memory::{Access, Atomic, Barrier, Event, Operation, Reply, Sequential, SharedMemory, WordAddress};
pub use retry::LEAST_RETRY_LIMIT;
pub use workgroup::{DispatchEnd, dispatch, dispatch_with_textures, set_invocation_ids, workgroup};
