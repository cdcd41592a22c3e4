//! The procedural macros of the language. Each takes the path of the serving crate in brackets, then the user's tokens;
//! `fragbuf-dsl` and `fragbuf` wrap them, so that users do not write the path.
//!
//! Input: the compiler's tokens. Output: the expansions of [`fragbuf_expansion`].

use proc_macro::TokenStream;

/// Expands to the module of a description; see `fragbuf_dsl::fragment_buffer!`.
#[proc_macro]
pub fn fragment_buffer(input: TokenStream) -> TokenStream {
    fragbuf_expansion::fragment_buffer(input.into()).into()
}

/// Captures a closure for the builder; see `fragbuf_dsl::closure!`.
#[proc_macro]
pub fn closure(input: TokenStream) -> TokenStream {
    fragbuf_expansion::closure(input.into()).into()
}

/// Captures a helper function for the builder; see `fragbuf_dsl::function!`.
#[proc_macro]
pub fn function(input: TokenStream) -> TokenStream {
    fragbuf_expansion::function(input.into()).into()
}
