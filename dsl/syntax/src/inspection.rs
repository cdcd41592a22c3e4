//! The names in the functions of a description, with their meanings: what an editor shows over a name, and what it offers in its place.
//!
//! Input: the source of a file. Output: the same draft and errors as from [`parse`](crate::parse), and what the type checker found for
//! each name. A name that begins with [`PLACEHOLDER`] is no error: the checker lists what could be in its place.

use fragbuf_model::{Diagnostics, SourceSpan};

use crate::parse::Parsed;
use crate::report::Report;
use crate::types::Type;
use crate::{lexer, parse};

/// The beginning of a name that stands for the name that a user is typing.
pub const PLACEHOLDER: &str = "fragbuf_name_being_typed";

/// The words that begin an item of a buffer, apart from the axes.
pub const ITEMS: [&str; 9] = crate::grammar::KEYWORDS;

/// The words that begin a statement or an expression of a function.
pub const STATEMENTS: [&str; 10] =
    ["let", "let mut", "if", "else", "for", "return", "break", "continue", "true", "false"];

/// The words of a description outside of functions, without axes, values and types.
pub const KEYWORDS: [&str; 6] = ["buffer", "from", "least", "all", "else", "wgsl"];

/// A description with the names of its functions.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// The draft and the errors.
    pub parsed: Parsed,
    /// The names in functions, in the order in which the type checker reads them.
    pub names: Vec<Name>,
    /// What can be in the place of the placeholder.
    pub candidates: Vec<Candidate>,
}

/// The kind of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NameKind {
    /// A parameter, or a variable of a `let` or a loop.
    Variable,
    /// An attribute of a fragment.
    Attribute,
    /// A uniform.
    Uniform,
    /// A `fn` of the description, or a function of the language.
    Function,
    /// A method of a type.
    Method,
    /// A component of a vector, or several.
    Component,
    /// A constant.
    Constant,
    /// A type.
    Type,
}

/// A name in a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The name as written.
    pub name: String,
    /// Its span.
    pub span: SourceSpan,
    /// Its kind.
    pub kind: NameKind,
    /// The name with its type, as Rust declares it: `x: f32`, `mut x: f32`, `fn sqrt(self: f32) -> f32`.
    pub signature: String,
    /// A remark on differences between Rust and shaders; may be empty.
    pub note: String,
    /// The span of its declaration, if a function or its signature declares it.
    pub declared: Option<SourceSpan>,
}

/// A name that can be written at the place of the placeholder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// The name.
    pub name: String,
    /// Its kind.
    pub kind: NameKind,
    /// The name with its type.
    pub signature: String,
    /// A remark on differences between Rust and shaders; may be empty.
    pub note: String,
}

/// Parses the source of a file, as [`parse`](crate::parse) does, and returns the names in its functions, too.
pub fn inspect(source: &str, file: &str) -> Inspection {
    let locate = lexer::locator(source, file);
    match lexer::tokens(source, file) {
        Ok(tokens) => {
            let mut report = Report::new(&locate).with_names();
            let (draft, _) = parse::read(tokens, &mut report);
            let (names, candidates) = report.take_names();
            Inspection { parsed: Parsed { draft, diagnostics: report.finish() }, names, candidates }
        }
        Err(invalid) => {
            let parsed = Parsed { draft: None, diagnostics: Diagnostics::from(*invalid) };
            Inspection { parsed, names: Vec::new(), candidates: Vec::new() }
        }
    }
}

/// Tests whether a name begins as the one that stands for what a user is typing.
pub(crate) fn is_placeholder(name: &str) -> bool {
    name.starts_with(PLACEHOLDER)
}

/// Returns the types that a user can write.
pub(crate) fn types() -> impl Iterator<Item = Candidate> {
    Type::NAMED.iter().map(|(name, _)| Candidate {
        name: (*name).to_owned(),
        kind: NameKind::Type,
        signature: (*name).to_owned(),
        note: String::new(),
    })
}
