//! Finds the local declarations of a function and their scopes.
//!
//! Input: the tokens of a function. Output: its parameters, variables and constants, each with the tokens of its scope.

use std::ops::Range;

use crate::link::token::{Token, TokenKind};

/// The keywords of declarations.
pub(super) const KEYWORDS: [&str; 3] = ["let", "var", "const"];

/// A declaration in a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Local<'a> {
    pub(super) name: &'a str,
    /// `let`, `var` or `const`; empty for a parameter.
    pub(super) keyword: &'a str,
    /// The tokens after it, up to the brace that ends its block.
    scope: Range<usize>,
    /// The number of open braces in its scope.
    depth: usize,
}

/// The declarations in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Locals<'a>(Vec<Local<'a>>);

impl<'a> Locals<'a> {
    /// Returns the declarations of a function.
    pub(super) fn of(tokens: &[Token<'a>]) -> Self {
        let mut locals = parameters(tokens);
        let mut depth = 0usize;
        for (index, token) in tokens.iter().enumerate() {
            match token.text {
                "{" => depth += 1,
                "}" => {
                    let ends = |local: &&mut Local<'_>| local.depth == depth && local.scope.end == tokens.len();
                    locals.iter_mut().filter(ends).for_each(|local| local.scope.end = index);
                    depth = depth.saturating_sub(1);
                }
                _ => locals.extend(declaration(tokens, index, depth)),
            }
        }
        Locals(locals)
    }

    /// Returns the innermost declaration of a name at a token.
    pub(super) fn at(&self, name: &str, index: usize) -> Option<&Local<'a>> {
        self.0.iter().rev().find(|local| local.name == name && local.scope.contains(&index))
    }

    /// Counts the declarations of a name.
    pub(super) fn count(&self, name: &str) -> usize {
        self.0.iter().filter(|local| local.name == name).count()
    }

    pub(super) fn declares(&self, name: &str) -> bool {
        self.0.iter().any(|local| local.name == name)
    }
}

/// Returns the token of the name in a declaration that begins at `index`: `let x`, `var<function> x`.
pub(super) fn declared(tokens: &[Token<'_>], index: usize) -> Option<usize> {
    KEYWORDS.contains(&tokens[index].text).then_some(())?;
    let is_listed = tokens.get(index + 1).is_some_and(|next| next.text == "<");
    let length = if is_listed { tokens[index..].iter().position(|token| token.text == ">")? } else { 0 };
    let name = index + length + 1;
    tokens.get(name).is_some_and(|token| token.kind == TokenKind::Name).then_some(name)
}

/// Returns the parameters: the names before a colon in the signature. Types contain no colon.
fn parameters<'a>(tokens: &[Token<'a>]) -> Vec<Local<'a>> {
    let open = tokens.iter().position(|token| token.text == "{").unwrap_or(tokens.len());
    let named = tokens[..open].windows(2).filter(|pair| pair[1].text == ":");
    let parameter = |pair: &[Token<'a>]| Local { name: pair[0].text, keyword: "", scope: open..tokens.len(), depth: 1 };
    named.map(parameter).collect()
}

fn declaration<'a>(tokens: &[Token<'a>], index: usize, depth: usize) -> Option<Local<'a>> {
    let name = declared(tokens, index)?;
    // Its scope does not include its initial value.
    let start = (name..tokens.len()).find(|&at| tokens[at].text == ";")?;
    // The scope of a declaration in the header of a `for` ends with the block of the loop.
    let is_in_header = index > 1 && tokens[index - 1].text == "(" && tokens[index - 2].text == "for";
    let depth = depth + usize::from(is_in_header);
    Some(Local { name: tokens[name].text, keyword: tokens[index].text, scope: start..tokens.len(), depth })
}
