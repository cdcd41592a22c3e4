//! What the tests of every host share. A test binary includes this file with a `#[path]`, and takes what it needs.
#![allow(dead_code, reason = "each test binary uses a part of it")]

pub mod continued;
pub mod cpu_image;
pub mod effects;
pub mod lookups;
pub mod numbers;
pub mod panes;
pub mod peeled_scene;
#[path = "../../backends/run/cpu/tests/peeling_loop.rs"]
pub mod peeling_loop;
pub mod reference;
pub mod rows;
pub mod scene;
pub mod sides;
pub mod technique;
pub mod tested_storage;
