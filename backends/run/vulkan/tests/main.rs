//! Generated SPIR-V on a Vulkan driver with the validation layer, at odd sizes, in slices and in permuted drawing
//! orders: every technique, every row of every axis. The image is that of a reference that shares no code with the
//! templates, or of the CPU device for techniques that state that they lose fragments. A message of the validation
//! layer is a failure.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by a panic")]

#[path = "../../../../tests/oracle/cpu_image.rs"]
mod cpu_image;
mod drivers;
mod interlock;
mod misuse;
#[path = "../../../../tests/oracle/numbers.rs"]
mod numbers;
#[path = "../../../../tests/oracle/peeled_scene.rs"]
mod peeled_scene;
mod peeling;
#[path = "../../cpu/tests/peeling_loop.rs"]
mod peeling_loop;
mod pixels;
mod program;
#[path = "../../../../tests/oracle/reference.rs"]
mod reference;
#[path = "../../../../tests/oracle/scene.rs"]
mod scene;
mod stage;
#[path = "../../../../tests/oracle/technique.rs"]
mod technique;
