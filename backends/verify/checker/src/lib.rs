//! Runs the fragments of one pixel in every interleaving, and checks a technique against its specification.
//!
//! ```text
//! Variant + Target ──Subject──► programs ──Case──► CaseRun ──explore──► Report: it holds, or the shortest failing schedule
//!                    (linked, checked by naga)         │                  │
//!                                        initial states, fragments      each step with its template's line
//! ```
//!
//! The programs are those of the target. `fragbuf-interpreter` runs them from one shared access to the next. The rows of the
//! variant declare the specification: the k best fragments, ties, order, exact counts of losses, and allocations of exactly what
//! is stored. In addition, the bound of an early cull is never too low, and there is no deadlock, livelock or data race. A wrong
//! final state that the hazards of the rows permit ([`Permits`](fragbuf_templates::vocabulary::Permits)) is a declared
//! hazard. There are two memory models ([`Model`]). [`check_shader`] checks any shader, without a description. [`ReadOut`]
//! reads what a pixel holds from the words that any device has left. Nothing here depends on the name of a technique.
//!
//! ```
//! use fragbuf_targets::TARGETS;
//! use fragbuf_checker::{Limits, check_variant};
//! use fragbuf_model::{Draft, SourceSpan, check};
//! use fragbuf_templates::Registry;
//!
//! // `.with(row)` adds a user row.
//! let registry = Registry::builtin();
//! let draft = Draft::from_technique("ab_ll", &SourceSpan::new("mine", 1, 1));
//! let variant = check(&draft, &registry).expect("a legal description");
//! let report = check_variant(&variant, &TARGETS[0], &registry, &Limits::default(), &mut |_| {}).expect("a report");
//! assert!(report.failure.is_none() && report.is_exhaustive);
//! ```

mod case;
mod case_check;
mod case_run;
mod case_setup;
mod context;
mod dispatches;
mod explore;
mod final_state;
mod fingerprint;
mod footprint;
mod fragments;
mod frame;
mod frame_memory;
mod graph;
mod in_order;
mod kept_set;
mod memory;
mod merging;
mod model;
mod outside;
mod pausing;
mod pool_case;
mod probe;
mod programs;
mod progress;
mod random_walk;
mod read_out;
mod reduced;
mod reduction;
mod relaxed;
mod report;
mod runner;
mod sampled;
mod search;
mod sequential;
mod shader;
mod specification;
mod state;
mod stream;
mod subject;
#[cfg(test)]
mod test_program;
mod trail;
mod turn;
mod verdict;
mod watched;
mod word_name;

pub use frame_memory::{FrameMemory, ReadOutError};
pub use model::Model;
pub use read_out::ReadOut;
pub use report::{Race, Schedule, ScheduleStep};
pub use shader::{Shader, check_shader};
pub use verdict::{Error, Limits, Report, check_variant};
