//! A closure or helper function after parsing and before type checking.
//!
//! Input: none; these types are plain data. The grammar creates them and the type checker reads them.

use fragbuf_model::{SourceSpan, Spanned, image_resource};
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
    /// After `between`: `|front, back, gap, u| -> Vec4`.
    Between,
    /// After `image` and this name: `|fragments, u| -> Vec4`.
    Image(String),
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
            Role::Between => "user_between".to_string(),
            Role::Image(name) => format!("user_{}", image_resource(name)),
            Role::Helper(name) => format!("user_{name}"),
        }
    }

    /// Whether the closure reads the list of fragments.
    pub(crate) fn reads_list(&self) -> bool {
        matches!(self, Role::Resolve | Role::Image(_))
    }

    /// Returns the usual parameters of a closure.
    pub(crate) fn usual_parameters(&self) -> &'static [&'static str] {
        match self {
            Role::Criterion | Role::Constraint(_) => &["f", "u"],
            Role::Resolve | Role::Image(_) => &["fragments", "u"],
            Role::Between => &["front", "back", "gap", "u"],
            Role::Helper(_) => &[],
        }
    }

    /// Returns the name of a helper or an image, or the keyword before a closure.
    pub(crate) fn rust_name(&self) -> &str {
        match self {
            Role::Criterion => "least",
            Role::Constraint(_) => "where",
            Role::Resolve => "resolve",
            Role::Between => "between",
            Role::Image(name) | Role::Helper(name) => name,
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
