//! Turns a checked variant into a plan of passes, and the plan into one linked WGSL source per pass.
//!
//! ```text
//! Variant ──select──► Selection ──plan──► Plan ──link──► Program: one WGSL source per pass, with a source map
//! ```
//!
//! A plan contains no source code. A program has not been checked by naga; `fragbuf-targets` does that. Statements come from templates
//! and from the closures of the description. This crate generates declarations, the packing of a fragment into words, the orders
//! over packed fragments, and the accessors of buffers.

mod contract;
mod contract_check;
mod definitions;
mod emit;
mod entry_point;
mod frame;
mod layout;
mod link;
mod linking;
mod markers;
mod plan;
mod program;
mod source_map;
mod symbols;
mod user_file;

pub use contract::{CONTRACTS, Contract};
pub use contract_check::verify;
pub use emit::UserBuffer;
pub use entry_point::{EntryPoint, Stage};
pub use frame::{
    Action, Command, Decision, Loop, LoopId, LoopUntil, LoweredFrame, Parity, PassId, PlannedPass, Range, ResourceId,
};
pub use layout::{Key, Layout, MemberSource, Word};
pub use linking::{Form, Linking, Profile};
pub use markers::{CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE, MARKERS, MEMORY_FENCE};
pub use plan::{Arrival, FIRST_BINDING, Part, Plan, PlannedResource, bucket, plan};
pub use program::{Notes, PassSource, Program, link};
pub use source_map::{LineSource, SourceMap};
pub use symbols::{PlanSymbol, PlanValue, Quantity, SymbolId, SymbolTable, Term, is_boolean};
pub use user_file::{too_long, user_row_warnings, validate_user_row};

/// The name and version that are written on the first line of every generated file.
pub const GENERATOR: &str = concat!("fragbuf ", env!("CARGO_PKG_VERSION"));
