//! What fragbuf promises, a module per kind of promise. External validators must be installed: nothing is skipped.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a test fails by panicking")]

mod vocabulary;
