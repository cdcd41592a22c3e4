//! The written form of a fragment buffer: grammar, type checker and WGSL lowering of its Rust subset.
//!
//! In: the text of a `.fragbuf` file, the tokens of a macro, or the parts that a builder collected. Out: a [`Draft`] whose
//! closures are type-checked and lowered to WGSL, and everything that is wrong, each at the user's own place.
//!
//! ```text
//! text ─► tokens ─► grammar ─► closures (syn) ─► check: typed tree ─► lower: WGSL
//! ```
//!
//! [`row()`] reads the other thing that users write: the row in the head of a WGSL file of their own.
//!
//! Nothing here knows a technique by name, looks anything up in the registry, or knows naga or wgpu.
//! Any text comes back as diagnostics: nothing here panics, and nesting is bounded.

mod captured;
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
mod parts;
mod reads;
mod reference;
mod report;
mod row;
mod text;
mod tree;
mod types;

pub use captured::Captured;
pub use grammar::{Role, Written};
pub use parts::{Part, Parts, assemble};
pub use reference::reference;
pub use row::row;

use fragbuf_model::{Diagnostics, Draft, Origin, Variant, check, codes};
use fragbuf_templates::Registry;
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

impl Parsed {
    /// The variant, if nothing is wrong with the text and the rules accept it. The rules run even over a draft with
    /// mistakes in it: all that is wrong comes at once.
    pub fn check(&self, registry: &Registry) -> Result<Variant, Diagnostics> {
        let mut diagnostics = self.diagnostics.clone();
        let Some(draft) = &self.draft else { return Err(diagnostics) };
        match check(draft, registry) {
            Ok(variant) => diagnostics.gate(variant),
            Err(more) => {
                // What an attribute of unknown format would have offered is not known: nothing is said of its absence.
                let unknown = diagnostics.iter().any(|found| found.code == codes::UNKNOWN_FORMAT);
                let follows = |code| unknown && (code == codes::UNMET || code == codes::MISSING_DEPTH);
                more.iter().filter(|found| !follows(found.code)).for_each(|found| diagnostics.push(found.clone()));
                // There is at least one, so the way on is never taken.
                diagnostics.gate(()).and_then(|()| check(draft, registry))
            }
        }
    }
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
    read_tokens(tokens, place).0
}

/// The same, with the functions in the user's own tokens, also those that are left out of the draft.
pub fn read_tokens(tokens: TokenStream, place: &dyn Fn(Span) -> Origin) -> (Parsed, Vec<Written>) {
    let mut report = report::Report::new(place);
    let read = nesting::bounded(tokens, &mut report).and_then(|tokens| grammar::description(tokens, &mut report));
    let (draft, written) = read.map_or((None, Vec::new()), |(draft, written)| (Some(draft), written));
    (Parsed { draft, diagnostics: report.finish() }, written)
}
