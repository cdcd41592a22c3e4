//! The textual form of a fragment buffer: grammar, type checker and WGSL lowering of its Rust subset.
//!
//! Input: the source of a `.fragbuf` file, the tokens of a macro, or the parts that a builder collected. Output: a [`Draft`]
//! whose closures are type-checked and lowered to WGSL, and every error with its span in the user's source.
//!
//! ```text
//! source ─► tokens ─► grammar ─► items, closures (syn) ─► check: typed tree ─► lower: WGSL
//! ```
//!
//! [`row()`] parses the other text that users write: the registry row in the header of a user's WGSL file.
//!
//! This crate does not use the registry, names no technique, and does not depend on naga or wgpu.
//! Every input gives a draft or diagnostics: nothing panics, and nesting is bounded.

mod captured_tokens;
mod check;
mod constants;
mod declarations;
mod draft;
mod environment;
mod fold;
mod foreign_functions;
mod foreign_names;
mod grammar;
mod infer;
mod inspection;
mod items;
mod lexer;
mod lower;
mod methods;
mod names;
mod outside;
mod parse;
mod parts;
mod raw_function;
mod reads;
mod reference;
mod report;
mod resumable;
mod row;
mod suspicious;
mod token_limits;
mod tree;
mod types;
mod unknown_name;

pub use captured_tokens::CapturedTokens;
pub use inspection::{Candidate, ITEMS, Inspection, KEYWORDS, Name, NameKind, PLACEHOLDER, STATEMENTS, inspect};
pub use outside::choice;
pub use parse::{Parsed, parse, parse_tokens, read_tokens};
pub use parts::{Part, Parts, assemble};
pub use raw_function::{FunctionTokens, Role};
pub use reference::{reference, type_of_attribute};
pub use row::row;
