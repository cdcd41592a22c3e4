//! Bevy on a software driver: the follower draws every technique to the pixels of the reference, and the plugin draws meshes.
#![allow(missing_docs, reason = "tests need no documentation")]

#[path = "../../../tests/oracle/cpu_image.rs"]
mod cpu_image;
mod meshes;
#[path = "../../../tests/oracle/numbers.rs"]
mod numbers;
#[path = "../../../tests/oracle/reference.rs"]
mod reference;
#[path = "../../../tests/oracle/scene.rs"]
mod scene;
#[path = "../../../tests/oracle/technique.rs"]
mod technique;
mod techniques;
