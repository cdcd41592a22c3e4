//! What stands in front of a description in a macro and is not part of the language: the serving crate, documentation
//! and visibility.
//!
//! In: all tokens. Out: each part apart. Whatever is not recognised stays with the description, whose grammar says so.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The tokens of a macro call, taken apart.
pub(crate) struct Front {
    /// The path of the crate whose items the expansion names.
    pub serving: TokenStream,
    /// `#[doc = "…"]`, as the compiler hands over `/// …`.
    pub documentation: TokenStream,
    /// `pub`, `pub(crate)`, or nothing.
    pub visibility: TokenStream,
    /// The rest.
    pub tokens: TokenStream,
}

impl Front {
    /// The parts of a description.
    pub(crate) fn of(input: TokenStream) -> Self {
        let mut front = Front::plain(input);
        let tokens: Vec<TokenTree> = std::mem::take(&mut front.tokens).into_iter().collect();
        let documented = documentation(&tokens);
        let (documentation, rest) = tokens.split_at(documented);
        let (visibility, rest) = rest.split_at(visibility(rest));
        front.documentation = documentation.iter().cloned().collect();
        front.visibility = visibility.iter().cloned().collect();
        front.tokens = rest.iter().cloned().collect();
        front
    }

    /// The serving crate, and everything else.
    pub(crate) fn plain(input: TokenStream) -> Self {
        let mut tokens = input.into_iter();
        let serving = match tokens.next() {
            Some(TokenTree::Group(group)) => group.stream(),
            _ => TokenStream::new(),
        };
        Front { serving, documentation: TokenStream::new(), visibility: TokenStream::new(), tokens: tokens.collect() }
    }
}

/// How many tokens at the beginning are `#[doc …]`.
fn documentation(tokens: &[TokenTree]) -> usize {
    let is_doc = |pair: &[TokenTree]| match pair {
        [TokenTree::Punct(sign), TokenTree::Group(group)] => {
            let first = group.stream().into_iter().next();
            sign.as_char() == '#'
                && group.delimiter() == Delimiter::Bracket
                && matches!(first, Some(TokenTree::Ident(word)) if word == "doc")
        }
        _ => false,
    };
    2 * tokens.chunks(2).take_while(|pair| is_doc(pair)).count()
}

/// How many tokens at the beginning are a visibility.
fn visibility(tokens: &[TokenTree]) -> usize {
    match tokens {
        [TokenTree::Ident(word), TokenTree::Group(group), ..]
            if word == "pub" && group.delimiter() == Delimiter::Parenthesis =>
        {
            2
        }
        [TokenTree::Ident(word), ..] if word == "pub" => 1,
        _ => 0,
    }
}
