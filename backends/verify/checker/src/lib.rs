//! Runs the fragments of one pixel in every order, and says whether a technique keeps what it promises.
//!
//! ```text
//! Variant + Target ──Subject──► programs ──Case──► Trial ──explore──► Report: it holds, or the shortest failing schedule
//!                    (linked, checked by naga)        │                  │
//!                                          prior states, fragments    each step with its template's line
//! ```
//!
//! The programs are those that a target gets, run by `fragbuf-interpreter` from one shared access to the next. What counts
//! as right is what the variant states: the k best, ties, order, losses counted exactly, room for what is stored, the bound
//! of an early cull never too low, nobody waiting for ever, no data race. What is not right, but no worse than the hazards
//! of the rows allow ([`Permits`](fragbuf_templates::vocabulary::Permits)), fails as stated. Memory behaves as one of two
//! models says ([`Model`]). [`check_shader`] does the same for any shader, without a description. [`ReadOut`] reads what a
//! pixel holds from the words that any device left. Nothing here knows a technique by name.
//!
//! ```
//! use fragbuf_targets::TARGETS;
//! use fragbuf_checker::{Limits, check_variant};
//! use fragbuf_model::{Draft, Origin, check};
//! use fragbuf_templates::Registry;
//!
//! // `.with(row)` adds a row of your own.
//! let registry = Registry::builtin();
//! let draft = Draft::from_technique("ab_ll", &Origin::new("mine", 1, 1));
//! let variant = check(&draft, &registry).expect("a legal description");
//! let report = check_variant(&variant, &TARGETS[0], &registry, &Limits::default(), &mut |_| {}).expect("a report");
//! assert!(report.failure.is_none() && report.is_whole);
//! ```

mod case;
mod explore;
mod fragments;
mod frame;
mod frame_memory;
mod merging;
mod model;
mod pausing;
mod policy;
mod promise;
mod question;
mod read_out;
mod report;
mod room;
mod sampled;
mod shader;
mod state;
mod stream;
mod subject;
mod texels;
mod trial;
mod verdict;
mod walk;

pub use frame_memory::{FrameMemory, ReadOutError};
pub use model::Model;
pub use read_out::ReadOut;
pub use report::{Line, Schedule};
pub use shader::{Shader, check_shader};
pub use verdict::{Error, Limits, Report, check_variant};
