//! A device without a driver: a rasteriser on the interpreter. It runs every plan on any machine.
//!
//! ```text
//! Variant ──Code::of──► Code (Bytecode per stage) ──Device::new──► Device ──render──► Picture
//!                                                                    ▲ Mesh: words of vertices and indices
//! ```
//!
//! A frame is divided into tiles. The fragments of a pixel run one after the other in submission order on one thread, and those of
//! different pixels of a tile in the lanes of one machine. Tiles run in parallel, so memory that pixels share (pools, counters) is
//! atomic. [`FragmentOrder::Shuffled`] interleaves the fragments of a pixel from one shared access to the next, as a GPU may.
//!
//! Rasterisation follows the rules of the graphics APIs: 8 subpixel bits, top-left rule, perspective-correct, linear and flat
//! attributes, clipping at the near and far planes, depth and stencil tests, blending, 1, 2, 4 or 8 samples, with or without
//! multisample coverage. Later passes read attachments as textures. Loops end by a counter or a query, box queries cull
//! objects, and draws and dispatches may be indirect. This crate is independent of techniques, naga's front end and GPUs.

mod attachment;
mod bound_texture;
mod clip;
mod code;
mod compute;
mod device;
mod draw;
mod draw_call;
mod error;
mod fixed_function;
mod fragment_stage;
mod fragments;
mod frame;
mod helpers;
mod interface;
mod lagged;
mod lane_group;
mod memory;
mod mesh;
mod picture;
mod schedule;
mod settings;
mod texel;
mod tile;
mod triangle;
mod vertices;
mod view;

pub use code::Code;
pub use device::Device;
pub use error::Error;
pub use mesh::Mesh;
pub use picture::{PassProgress, Picture};
pub use settings::{FragmentOrder, Settings};
