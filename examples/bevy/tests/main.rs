//! Bevy on a software driver: the follower draws every technique to the pixels of the reference, and the plugin draws meshes.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by a panic")]

#[path = "../../../tests/oracle/cpu_image.rs"]
mod cpu_image;
#[path = "../examples/glass.rs"]
#[allow(dead_code, reason = "the example has a window of its own")]
mod glass;
mod meshes;
#[path = "../../../tests/oracle/numbers.rs"]
mod numbers;
mod pictures;
#[path = "../../../tests/oracle/reference.rs"]
mod reference;
#[path = "../../../tests/oracle/scene.rs"]
mod scene;
#[path = "../../../tests/oracle/technique.rs"]
mod technique;
mod techniques;
