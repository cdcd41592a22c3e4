//! Tests of fragbuf's promises, one module per kind. External validators must be installed: nothing is skipped.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by panicking, and prints its counts"
)]

mod analysis;
mod arrangement;
mod attributes;
mod bindings;
mod blocks;
mod browser;
mod build_script;
mod c_header;
mod camera;
mod cases;
mod catalogue;
mod check;
mod closures;
mod command_line;
mod devices;
mod diagnostics;
mod editors;
mod effects;
mod examples;
#[cfg(feature = "figures")]
mod figures;
mod fixes;
mod fuzz;
mod importance;
mod inputs;
mod instances;
mod language_server;
mod limits;
mod manifests;
mod material;
mod memory;
mod messages;
mod multisample;
mod names;
mod new_crate;
mod no_op_rows;
mod opaque;
mod options;
mod oracle;
mod playground;
mod playground_requests;
mod predict;
mod product;
mod quads;
mod render;
mod site;
mod snapshots;
mod suggestions;
mod textures;
mod tidy;
mod tint;
mod user_files;
mod validators;
mod vocabulary;
mod watch;
