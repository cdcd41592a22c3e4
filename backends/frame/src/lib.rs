//! The arithmetic of a frame, the same for every device that runs a plan: values of the symbols in formulas, sizes of
//! buffers, room for fragments that nobody has counted yet, decisions of the host, uniform words, counters.
//!
//! In: a plan and the frame's size. Out: numbers and words. Nothing here knows a device, and nothing is allocated.

mod counters;
mod error;
mod host;
mod looped;
mod pass_time;
mod room;
mod symbols;
mod uniforms;
mod unrolled;

pub use counters::{COUNTERS_RESOURCE, Counter, Counters, OUT_OF_ORDER, PARTLY_COVERED, POOL_EXHAUSTED};
pub use error::Error;
pub use host::Decision;
pub use looped::{LoopEnd, Looped};
pub use pass_time::PassTime;
pub use room::{Counting, Room, Sizing, bytes, reserve, symbols};
pub use symbols::Symbols;
pub use uniforms::{Value, set, zeros};
pub use unrolled::{Turn, rounds, unrolled};

use fragbuf_codegen::Plan;

/// The index of a resource of the plan.
pub fn resource(plan: &Plan, name: &str) -> Result<usize, Error> {
    let index = plan.resources.iter().position(|planned| planned.resource.name == name);
    index.ok_or_else(|| unsupported(format!("`{name}`, which the plan does not have")))
}

/// A refusal of something that a plan says and no device here does.
pub fn unsupported(what: String) -> Error {
    Error::Unsupported {
        what,
        hint: "follow the manifest with an engine of your own, or take another technique".to_owned(),
    }
}
