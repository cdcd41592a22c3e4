//! From a checked variant to a plan of passes, and from the plan to one linked WGSL text per pass.
//!
//! ```text
//! Variant ──select──► Selection ──plan──► Plan ──link──► Program: one WGSL text per pass, each line with its source
//! ```
//!
//! A plan has no text in it, and a program nothing that naga has seen: `fragbuf-targets` checks it. Statements come from
//! templates and from the user's closures; what is generated here is declarations, the packing of a fragment into words,
//! the orders over packed fragments, and the accessors of buffers.

mod contract;
mod definitions;
mod emit;
mod frame;
mod layout;
mod link;
mod markers;
mod own;
mod plan;
mod program;
mod symbols;

pub use contract::{CONTRACTS, Contract, verify};
pub use frame::{
    Action, Command, Decision, Loop, LoopId, LoopUntil, LoweredFrame, Parity, PassId, PlannedPass, Range, ResourceId,
};
pub use layout::{Key, Layout, Word};
pub use markers::{CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE, MARKERS, MEMORY_FENCE};
pub use own::adopt;
pub use plan::{Arrival, FIRST_BINDING, Part, Plan, Planned, bucket, plan};
pub use program::{EntryPoint, Form, LineMap, LineOrigin, Linking, Notes, PassText, Profile, Program, Stage, link};
pub use symbols::{PlanSymbol, PlanValue, Quantity, SymbolId, SymbolTable, Term, is_truth};

/// What a generator puts on the first line of every file that it writes.
pub const GENERATOR: &str = concat!("fragbuf ", env!("CARGO_PKG_VERSION"));
