//! Plans, run: what every technique keeps and shows is compared with a plain oracle, on whatever adapter there is (the
//! CPU's first). A machine without any fails here; nothing is skipped.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by panicking"
)]

mod kept;
mod oracle;
mod order;
mod quads;
mod samples;
mod stage;

mod buckets;
mod capture;
mod cpu_device;
mod criteria;
mod embedding;
mod failures;
mod invariance;
mod larger;
mod losses;
mod lowered;
mod merging;
mod multisample;
mod occupancy;
mod opaque;
mod opaque_depth;
mod overflow;
mod own_storage;
mod rasterisation;
mod routing;
mod sizing;
mod sloped;
mod sorts;
mod textures;
mod ties;
mod translations;
