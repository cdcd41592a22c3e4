//! Checks the techniques, templates that are wrong on purpose, and every mutant of a template.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints what it counted"
)]

mod compiles;
mod hazards;
mod litmus;
mod lowered;
mod mutants;
mod mutation;
mod occupancy;
mod opaque;
mod progress;
mod races;
mod read_out;
mod reduction;
mod regressions;
mod relaxed;
mod repairs;
mod repeated;
mod shapes;
mod subjects;
mod survivors;
mod survivors_of_peeling;
mod survivors_of_races;
mod survivors_of_slots;
mod threads;
mod verdicts;
