//! No library: the tests are in `main.rs`, the bench in `benches/`.
