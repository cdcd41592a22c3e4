//! A closure or helper function after parsing and before type checking.
//!
//! Input: none; these types are plain data. The grammar creates them and the type checker reads them.

use fragbuf_model::{SourceSpan, Spanned};
use proc_macro2::TokenStream;

/// The purpose of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// After `least`: `|f, u| -> f32`.
    Criterion,
    /// The `where` of this index, from 0: `|f, u| -> bool`.
    Constraint(usize),
    /// After `resolve`: `|fragments, u| -> Vec4`.
    Resolve,
    /// `fn` of this name.
    Helper(String),
}

impl Role {
    /// Returns the function's name in WGSL.
    pub(crate) fn wgsl_name(&self) -> String {
        match self {
            Role::Criterion => "user_criterion".to_string(),
            Role::Constraint(index) => format!("user_admit_{index}"),
            Role::Resolve => "user_resolve".to_string(),
            Role::Helper(name) => format!("user_{name}"),
        }
    }

    /// Returns the name of a helper, or the keyword before a closure.
    pub(crate) fn rust_name(&self) -> &str {
        match self {
            Role::Criterion => "least",
            Role::Constraint(_) => "where",
            Role::Resolve => "resolve",
            Role::Helper(name) => name,
        }
    }
}

/// A function as the user's tokens, without documentation comments.
#[derive(Clone, Debug)]
pub struct FunctionTokens {
    /// The purpose of the function.
    pub role: Role,
    /// The tokens from `|` or `fn` to the end of the function.
    pub tokens: TokenStream,
}

/// A function parsed as Rust.
pub(crate) struct RawFunction {
    pub role: Role,
    pub span: SourceSpan,
    /// The name of a helper, or the first `|` of a closure.
    pub name_span: SourceSpan,
    pub rust: String,
    pub parameters: Vec<RawParameter>,
    /// The type after `->`, if given.
    pub output: Option<syn::Type>,
    pub body: syn::Expr,
}

/// A parameter parsed as Rust.
pub(crate) struct RawParameter {
    /// `None` for `_`.
    pub name: Option<Spanned<String>>,
    pub mutable: bool,
    pub ty: Option<syn::Type>,
    pub span: SourceSpan,
}
