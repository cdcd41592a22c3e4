//! The procedural macros of the language. Each takes the path of the crate that serves it in brackets, then the user's
//! tokens; `fragbuf-dsl` wraps them so that users write neither.
//!
//! In: the compiler's tokens. Out: what [`fragbuf_expansion`] makes of them. Nothing happens here.

use proc_macro::TokenStream;

/// See `fragbuf_dsl::fragment_buffer!`.
#[proc_macro]
pub fn fragment_buffer(input: TokenStream) -> TokenStream {
    fragbuf_expansion::fragment_buffer(input.into()).into()
}

/// See `fragbuf_dsl::closure!`.
#[proc_macro]
pub fn closure(input: TokenStream) -> TokenStream {
    fragbuf_expansion::closure(input.into()).into()
}

/// See `fragbuf_dsl::function!`.
#[proc_macro]
pub fn function(input: TokenStream) -> TokenStream {
    fragbuf_expansion::function(input.into()).into()
}
