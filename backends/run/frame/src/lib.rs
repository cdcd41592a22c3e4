//! A frame of a plan, for every device that runs one: the cursor that steps through its commands, values of the symbols in
//! formulas, sizes of buffers, memory for fragments that nobody has counted yet, uniform words, counters.
//!
//! In: a plan and the frame's size. Out: turns, numbers and words. No device is named here, and nothing is allocated.

mod boxes;
mod counters;
mod cursor;
mod error;
mod looped;
mod pass_time;
mod room;
mod uniforms;
mod values;

pub use boxes::{BOX_CORNERS, BOX_TRIANGLES, box_corners, box_vertices, is_cut_by_near_plane};
pub use counters::{COUNTERS_RESOURCE, Counter, Counters, OUT_OF_ORDER, PARTLY_COVERED, POOL_EXHAUSTED};
pub use cursor::{Cursor, Question, Run, Span, Turn, most_iterations, most_runs};
pub use error::Error;
pub use looped::{LoopEnd, Looped};
pub use pass_time::PassTime;
pub use room::{Counting, Room, Sizing, bytes, decided, reserve, room_after, values};
pub use uniforms::{Value, set, zeros};
pub use values::Values;

use fragbuf_codegen::{Plan, ResourceId};

/// The handle of a resource by name, for what comes from outside.
pub fn resource(plan: &Plan, name: &str) -> Result<ResourceId, Error> {
    plan.resource_id(name).ok_or_else(|| unsupported(format!("`{name}`, which the plan does not have")))
}

/// A refusal of something that a plan says and no device here does.
pub fn unsupported(what: String) -> Error {
    Error::Unsupported {
        what,
        hint: "follow the manifest with an engine of your own, or take another technique".to_owned(),
    }
}
