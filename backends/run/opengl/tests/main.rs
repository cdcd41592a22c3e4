//! Generated GLSL on a real driver of OpenGL and OpenGL ES, in program and module form, at odd sizes and in permuted drawing orders: every
//! technique, every row of every axis, every k below the capacity. The image is that of a reference that shares no code with the
//! templates, or of the CPU device for techniques that state that they lose fragments.
#![allow(missing_docs, reason = "tests need no documentation")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by a panic")]

#[path = "../../../../tests/oracle/cpu_image.rs"]
mod cpu_image;
mod draw;
mod errors;
mod facing;
mod material;
#[path = "../../../../tests/oracle/numbers.rs"]
mod numbers;
#[path = "../../../../tests/oracle/peeled_scene.rs"]
mod peeled_scene;
mod peeling;
#[path = "../../cpu/tests/peeling_loop.rs"]
mod peeling_loop;
mod peers;
mod pixels;
mod program;
#[path = "../../../../tests/oracle/reference.rs"]
mod reference;
#[path = "../../../../tests/oracle/scene.rs"]
mod scene;
mod targets;
#[path = "../../../../tests/oracle/technique.rs"]
mod technique;
