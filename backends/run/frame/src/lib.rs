//! A frame of a plan, for every device that runs one: the cursor that steps through its commands, values of the symbols in
//! formulas, sizes of buffers, rows of a slice within a memory budget, capacities for uncounted fragments, decisions that lag,
//! uniform words, counters.
//!
//! Input: a plan and the frame's size. Output: steps, numbers and words. This crate names no device and allocates nothing on
//! one.

mod boxes;
mod condition;
mod counters;
mod cursor;
mod described;
mod error;
mod host_step;
mod lag;
mod loop_report;
mod loops;
mod memory;
mod pass_time;
mod pool_size;
mod step;
mod uniforms;
mod values;

pub use boxes::{
    BOX_CORNERS, BOX_TRIANGLES, box_around, box_corners, box_vertices, grown_box, is_below_a_pixel,
    is_cut_by_near_plane,
};
pub use condition::{Condition, ConditionWord, Conditions, LOOP_WORDS, check_conditions, loop_reports, object_queries};
pub use counters::{COUNTERS_RESOURCE, Counter, Counters, OUT_OF_ORDER, PARTIAL_COVERAGE, POOL_EXHAUSTED};
pub use cursor::{Cursor, first_of_query};
pub use described::{MAX_TEXTURE_SIDE, described_texture};
pub use error::{Error, MemoryNeed};
pub use host_step::decide;
pub use lag::{Decisions, LaggedValues};
pub use loop_report::{LoopEnd, LoopReport};
pub use loops::{max_iterations, max_pass_runs};
pub use memory::{BufferLimit, DEFAULT_MEMORY, MemoryLimits, buffer_bytes, most_rows, resource_bytes};
pub use pass_time::PassTime;
pub use pool_size::{
    PoolSize, Readbacks, Sizing, host_sets_k, initial_values, pool_size_after, reserve, reuse_pool_sizes,
};
pub use step::{FrameStep, HostRead, HostWait, PassRun, WordRange};
pub use uniforms::{Value, set_uniform, zero_uniforms};
pub use values::Values;

use fragbuf_codegen::{Plan, ResourceId};

/// Returns the handle of a resource whose name comes from the caller.
pub fn resource(plan: &Plan, name: &str) -> Result<ResourceId, Error> {
    plan.resource_id(name).ok_or_else(|| unsupported(format!("`{name}`, which the plan does not have")))
}

/// Returns the error for a part of a plan that no device of fragbuf supports.
pub fn unsupported(what: String) -> Error {
    Error::Unsupported { what, help: "run the manifest with your own engine, or use another technique".to_owned() }
}
