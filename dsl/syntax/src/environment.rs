//! The names outside a function that its body can use.
//!
//! Input: none; these types are plain data. The type checker and the WGSL printer read them.

use fragbuf_model::{Incomplete, SourceSpan};

use crate::types::Type;

/// The names that every function of a description can use.
pub(crate) struct Environment {
    /// Attributes of a fragment.
    pub attributes: Vec<(String, Type)>,
    pub uniforms: Vec<(String, Type)>,
    pub helpers: Vec<Signature>,
    /// The names of constants among the items, which are errors.
    pub constants: Vec<String>,
    /// The lists that lack names with errors.
    pub incomplete: Incomplete,
}

/// The signature of a helper function.
pub(crate) struct Signature {
    pub name: String,
    pub span: SourceSpan,
    pub parameters: Vec<Type>,
    pub result: Type,
}
