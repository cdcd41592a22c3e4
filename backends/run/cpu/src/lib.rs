//! A device without a driver: a rasteriser around the interpreter. Every plan runs here, on any machine.
//!
//! ```text
//! Variant ──Code::of──► Code (a Program per stage) ──Device::new──► Device ──render──► Picture
//!                                                                     ▲ Mesh: words of vertices and indices
//! ```
//!
//! The frame is cut into tiles. Fragments of one pixel run one after the other, in the order of submission, on one thread;
//! tiles run in parallel, so what pixels share (pools, counters) is atomic. [`Order::Shuffled`] interleaves the fragments of
//! a pixel instead, from one shared access to the next, as a GPU may.
//!
//! Rasterisation follows the rules of the graphics APIs: 8 bits of subpixel, top left edges, perspective-correct and flat
//! attributes, clipping at the near and far planes, depth and stencil tests, blending, 1, 2, 4 or 8 samples, with multisample
//! coverage or without. Attachments are read as textures by later passes, loops end when a counter or a query says so, objects are
//! drawn by their boxes' queries, draws and dispatches by arguments in a buffer. Nothing here knows a technique, naga's front
//! end or a GPU.

mod attachment;
mod clip;
mod code;
mod compute;
mod device;
mod draw;
mod error;
mod fixed_function;
mod fragments;
mod frame;
mod interface;
mod memory;
mod sampled;
mod schedule;
mod stages;
mod texel;
mod tile;
mod triangle;
mod vertices;
mod view;

pub use code::Code;
pub use device::{Device, Mesh, Order, Picture, Settings, Stage};
pub use error::Error;
