//! The written form of a fragment buffer: grammar, type checker and WGSL lowering of its Rust subset.
//!
//! In: the text of a `.fragbuf` file, or the tokens of another door to the same language. Out: a [`Draft`] whose closures
//! are type-checked and lowered to WGSL, and everything that is wrong, each at the user's own place.
//!
//! ```text
//! text ─► tokens ─► grammar ─► closures (syn) ─► check: typed tree ─► lower: WGSL
//! ```
//!
//! [`row()`] reads the other thing that users write: the row in the head of a WGSL file of their own.
//!
//! Nothing here knows a technique by name, looks anything up in the registry, or knows naga or wgpu.
//! Any text comes back as diagnostics: nothing here panics, and nesting is bounded.

mod check;
mod constants;
mod fold;
mod functions;
mod grammar;
mod infer;
mod lower;
mod methods;
mod near;
mod nesting;
mod reads;
mod report;
mod row;
mod text;
mod tree;
mod types;

pub use row::row;

use fragbuf_model::{Diagnostics, Draft, Origin};
use proc_macro2::{Span, TokenStream};

/// What came of reading a description.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// The description, as far as it could be understood: functions with mistakes are left out. Absent where there was no
    /// `buffer` to read.
    pub draft: Option<Draft>,
    /// Everything that is wrong, in the order of the text. Empty: the draft is whole.
    pub diagnostics: Diagnostics,
}

/// Reads the text of a `.fragbuf` file; `file` is its name in messages.
pub fn parse(text: &str, file: &str) -> Parsed {
    let place = text::places(text, file);
    match text::tokens(text, file) {
        Ok(tokens) => parse_tokens(tokens, &place),
        Err(unreadable) => Parsed { draft: None, diagnostics: (*unreadable).into() },
    }
}

/// Reads the tokens of a description; `place` says where each stands in the user's text.
pub fn parse_tokens(tokens: TokenStream, place: &dyn Fn(Span) -> Origin) -> Parsed {
    let mut report = report::Report::new(place);
    let draft = nesting::bounded(tokens, &mut report).and_then(|tokens| grammar::description(tokens, &mut report));
    Parsed { draft, diagnostics: report.finish() }
}
