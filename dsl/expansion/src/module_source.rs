//! The parts from which the module of a description is emitted.

use fragbuf_model::Draft;
use fragbuf_syntax::FunctionTokens;
use proc_macro2::TokenStream;

use crate::macro_input::MacroInput;

/// A description, read and captured.
pub(crate) struct ModuleSource<'a> {
    pub input: &'a MacroInput,
    pub draft: &'a Draft,
    pub functions: &'a [FunctionTokens],
    /// The expression that gives the description to the running program.
    pub description: TokenStream,
    pub bodies: Bodies,
}

/// The reader of the bodies of the user's functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bodies {
    /// The compiler: there is no error.
    Compiled,
    /// Only editors, to complete in them.
    ForEditors,
}
