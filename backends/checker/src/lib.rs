//! Runs the fragments of one pixel in every order, and says whether a technique keeps what it promises.
//!
//! ```text
//! Variant + Target ──Subject──► programs ──Case──► Trial ──explore──► Report: it holds, or the shortest failing schedule
//!                    (linked, checked by naga)        │                  │
//!                                          prior states, fragments    each step with its template's line
//! ```
//!
//! The programs are those that a target gets, run by `fragbuf-interpreter` from one shared access to the next. What counts
//! as right is what the variant states: the k best, ties, losses counted exactly, the bound of an early cull never too low,
//! nobody waiting for ever, no data race. Memory behaves as one of two models says ([`Model`]). [`check_shader`] does the same for any shader, without a description. Nothing here knows a
//! technique by name.

mod case;
mod explore;
mod fragments;
mod frame;
mod model;
mod policy;
mod report;
mod shader;
mod state;
mod subject;
mod trial;
mod verdict;
mod walk;

pub use model::Model;
pub use report::{Line, Schedule};
pub use shader::{Shader, check_shader};
pub use verdict::{Error, Limits, Report, check_variant};
