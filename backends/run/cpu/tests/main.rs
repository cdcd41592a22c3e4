//! Runs small plans: fixed function, textures, loops, queries and indirect arguments on this device.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod dual;
mod helpers;
mod host;
mod indirect;
mod interleaved;
mod lanes;
mod objects;
mod peeling;
mod peeling_loop;
mod primitives;
mod rejected_plans;
mod routing;
mod slices;
mod stage;
mod textures;
