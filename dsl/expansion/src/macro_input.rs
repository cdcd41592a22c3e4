//! The input of a macro: the serving crate, documentation and visibility come before the description and are not part of
//! the language.
//!
//! Input: all tokens. Output: the parts. A token that is not recognised stays with the description, and the grammar
//! reports it.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The parts of a macro call.
pub(crate) struct MacroInput {
    /// The path of the crate whose items the expansion names.
    pub serving: TokenStream,
    /// `#[doc = "…"]`, as the compiler passes `/// …`.
    pub documentation: TokenStream,
    /// `pub`, `pub(crate)`, or nothing.
    pub visibility: TokenStream,
    /// The description, or the function for the builder.
    pub tokens: TokenStream,
}

impl MacroInput {
    /// Splits the call of `fragment_buffer!`.
    pub(crate) fn of_description(input: TokenStream) -> Self {
        let mut input = MacroInput::of_function(input);
        let tokens: Vec<TokenTree> = std::mem::take(&mut input.tokens).into_iter().collect();
        let (documentation, rest) = tokens.split_at(documentation_length(&tokens));
        let (visibility, rest) = rest.split_at(visibility_length(rest));
        input.documentation = documentation.iter().cloned().collect();
        input.visibility = visibility.iter().cloned().collect();
        input.tokens = rest.iter().cloned().collect();
        input
    }

    /// Splits the call of `closure!` or `function!`: the serving crate, and everything else.
    pub(crate) fn of_function(input: TokenStream) -> Self {
        let mut tokens = input.into_iter();
        let serving = match tokens.next() {
            Some(TokenTree::Group(group)) => group.stream(),
            _ => TokenStream::new(),
        };
        MacroInput {
            serving,
            documentation: TokenStream::new(),
            visibility: TokenStream::new(),
            tokens: tokens.collect(),
        }
    }
}

/// Returns how many tokens at the beginning are `#[doc …]`.
fn documentation_length(tokens: &[TokenTree]) -> usize {
    let is_doc = |pair: &[TokenTree]| match pair {
        [TokenTree::Punct(sign), TokenTree::Group(group)] => {
            let first = group.stream().into_iter().next();
            sign.as_char() == '#'
                && group.delimiter() == Delimiter::Bracket
                && matches!(first, Some(TokenTree::Ident(name)) if name == "doc")
        }
        _ => false,
    };
    2 * tokens.chunks(2).take_while(|pair| is_doc(pair)).count()
}

/// Returns how many tokens at the beginning are a visibility.
fn visibility_length(tokens: &[TokenTree]) -> usize {
    match tokens {
        [TokenTree::Ident(keyword), TokenTree::Group(group), ..]
            if keyword == "pub" && group.delimiter() == Delimiter::Parenthesis =>
        {
            2
        }
        [TokenTree::Ident(keyword), ..] if keyword == "pub" => 1,
        _ => 0,
    }
}
