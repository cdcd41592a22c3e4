//! The registry of fragbuf: complete WGSL templates, each with a row of data that declares what it requires and
//! provides.
//!
//! [`vocabulary`] defines what a row can declare; one module per axis holds the rows of that axis.
//! [`Registry::builtin`] has all rows of fragbuf, and [`Registry::with`] adds a user row. This crate only holds data:
//! `fragbuf-model` checks the rules over rows, and `fragbuf-codegen` generates passes from them.

pub mod vocabulary;

/// Includes the WGSL file `templates/<path>.wgsl` as a [`vocabulary::Template`].
macro_rules! template {
    ($path:literal) => {
        $crate::vocabulary::Template {
            path: std::borrow::Cow::Borrowed(concat!($path, ".wgsl")),
            source: std::borrow::Cow::Borrowed(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/", $path, ".wgsl"))),
            user_file: None,
        }
    };
}

mod addressing;
mod allocation;
mod conditions;
mod counters;
mod cull;
mod d13_table_1;
mod host;
mod importance;
mod objects;
mod opaque;
mod overflow;
mod paper_table;
mod pass;
mod peeling;
mod prediction;
mod registry;
mod resolve;
mod samples;
mod select;
mod shared;
mod shorthand;
mod sort;
mod storage;
mod sync;
mod table_1;
mod technique;
mod ties;

pub use counters::{COUNTERS, CounterKind};
pub use d13_table_1::D13_TABLE_1;
pub use paper_table::{Column, PaperRow, PaperTable, Property};
pub use prediction::{BINS, BudgetTooSmall, Histogram, HitRatio, Prediction};
pub use registry::Registry;
pub use resolve::SHOWN_LAYER;
pub use shorthand::Shorthand;
pub use table_1::TABLE_1;
