//! Whole plans of a few lines each: what the fixed function, textures, loops, queries and arguments of a plan do on this device.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod dual;
mod host;
mod indirect;
mod interleaved;
mod objects;
mod peeling;
mod primitives;
mod refusals;
mod routing;
mod stage;
mod textures;
