//! The registry of fragbuf: whole WGSL templates, each with the row of data that says what it needs and what it offers.
//!
//! [`vocabulary`] is what a row can say; one module per axis holds that axis's rows beside the text they include.
//! [`Registry::builtin`] is all of them, and [`Registry::with`] adds a row of the user's own. Nothing here computes: the
//! rules over rows are `fragbuf-model`'s, the passes made from them `fragbuf-codegen`'s.

pub mod vocabulary;

/// The whole WGSL file `templates/<path>.wgsl`, as a [`vocabulary::Template`].
macro_rules! template {
    ($path:literal) => {
        $crate::vocabulary::Template {
            path: std::borrow::Cow::Borrowed(concat!($path, ".wgsl")),
            text: std::borrow::Cow::Borrowed(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/", $path, ".wgsl"))),
            own: None,
        }
    };
}

mod addressing;
mod conditions;
mod counters;
mod cull;
mod host;
mod opaque;
mod overflow;
mod pass;
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

pub use counters::COUNTERS;
pub use registry::Registry;
pub use shorthand::Shorthand;
pub use table_1::{PaperRow, TABLE_1};
