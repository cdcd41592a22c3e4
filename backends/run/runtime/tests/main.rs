//! Runs plans and compares the kept fragments and the image of every technique with a plain oracle, on the CPU's adapter. The
//! tests fail on a machine without it; none is skipped.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by a panic"
)]

mod kept;
mod oracle;
mod order;
#[path = "../../cpu/tests/peeling_loop.rs"]
mod peeling_loop;
mod quads;
mod samples;
mod stage;

mod allocation;
mod buckets;
mod capture;
mod conditions;
mod continued;
mod cpu_device;
mod criteria;
mod culled_objects;
mod drivers;
mod effects;
mod embedding;
mod failures;
mod importance;
mod invariance;
mod lagged;
mod larger;
mod limits;
mod lookups;
mod losses;
mod lowered;
mod manifests;
mod merging;
mod multisample;
mod occupancy;
mod opaque;
mod opaque_depth;
mod overflow;
mod parallel;
mod peeling;
mod peeling_slots;
mod rasterisation;
mod routing;
mod single_layers;
mod sizing;
mod sloped;
mod sorts;
mod temporal;
mod textures;
mod ties;
mod translations;
mod user_storage;
mod validation;
