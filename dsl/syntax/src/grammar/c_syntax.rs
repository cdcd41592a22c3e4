//! Syntax of GLSL, HLSL and WGSL in closures, and what Rust has instead.
//!
//! Input: tokens that are not Rust. Output: the help of the error, if they look like another language.

use std::borrow::Cow;

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

use super::cursor::is_punct;
use crate::{foreign_names, token_limits};

/// Returns the help for the first part that another language has.
pub(super) fn help(tokens: &TokenStream) -> Option<Cow<'static, str>> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    (0..tokens.len()).find_map(|at| {
        let rest = tokens.get(at..).unwrap_or_default();
        match rest.first() {
            Some(TokenTree::Group(group)) => help(&group.stream()),
            _ => pattern(rest),
        }
    })
}

fn pattern(tokens: &[TokenTree]) -> Option<Cow<'static, str>> {
    if matches!(tokens.first(), Some(TokenTree::Ident(word)) if word == "not") {
        return Some(format!("write `!{}`", operand(tokens.get(1..).unwrap_or_default())).into());
    }
    fixed_pattern(tokens).map(Cow::Borrowed)
}

/// Returns the operand that follows `not`, up to the next logical operator: `not` of other languages precedes a whole comparison.
fn operand(tokens: &[TokenTree]) -> String {
    let is_part = |token: &&TokenTree| match token {
        TokenTree::Ident(word) => word != "and" && word != "or",
        TokenTree::Group(group) => group.delimiter() != Delimiter::Brace,
        TokenTree::Punct(punct) => !matches!(punct.as_char(), '&' | '|' | ',' | ';' | '?'),
        TokenTree::Literal(_) => true,
    };
    let parts: Vec<TokenTree> = tokens.iter().take_while(is_part).cloned().collect();
    let is_path = parts.iter().all(|token| !matches!(token, TokenTree::Punct(_)) || is_punct(Some(token), '.'));
    match token_limits::compact(&token_limits::spaced(&parts.into_iter().collect())) {
        source if source.is_empty() => "x".to_owned(),
        source if is_path => source,
        source => format!("({source})"),
    }
}

fn fixed_pattern(tokens: &[TokenTree]) -> Option<&'static str> {
    let ident = |at: usize| match tokens.get(at) {
        Some(TokenTree::Ident(name)) => Some(name.to_string()),
        _ => None,
    };
    let parentheses =
        matches!(tokens.get(1), Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
    let joint = |character: char| {
        matches!(tokens.first(), Some(TokenTree::Punct(punct)) if punct.as_char() == character && punct.spacing() == Spacing::Joint)
            && is_punct(tokens.get(1), character)
    };
    let generic =
        ident(0).filter(|_| is_punct(tokens.get(1), '<') && ident(2).is_some() && is_punct(tokens.get(3), '>'));
    if let Some(help) = generic.and_then(|name| foreign_names::generic_constructor(&name)) {
        return Some(help);
    }
    match ident(0).as_deref() {
        Some("and") => return Some("write `&&`"),
        Some("or") => return Some("write `||`"),
        _ => {}
    }
    // Comparisons of other languages. `=>` is also in a `match`, which is described elsewhere.
    let second = |character: char| is_punct(tokens.get(1), character);
    if (joint('=') || is_punct(tokens.first(), '!') && second('=')) && is_punct(tokens.get(2), '=') {
        return Some(if joint('=') { "write `==`" } else { "write `!=`" });
    }
    match tokens.first() {
        Some(TokenTree::Punct(punct)) if punct.as_char() == '=' && second('<') => return Some("write `<=`"),
        Some(TokenTree::Punct(punct)) if punct.as_char() == '=' && second('!') => return Some("write `!=`"),
        Some(TokenTree::Punct(punct)) if punct.as_char() == '<' && second('>') => return Some("write `!=`"),
        _ => {}
    }
    // `.5` after an operator.
    let is_operator =
        ['<', '>', '=', '+', '-', '*', '/', ','].iter().any(|operator| is_punct(tokens.first(), *operator));
    if is_operator && is_punct(tokens.get(1), '.') && matches!(tokens.get(2), Some(TokenTree::Literal(_))) {
        return Some("write a digit before the point: `0.5`");
    }
    // A keyword of Rust.
    if ident(0).as_deref() == Some("mod") && parentheses {
        return Some("write `x - y * (x / y).floor()` for `mod(x, y)`");
    }
    if ident(0).as_deref() == Some("for") && parentheses {
        return Some("write `for i in 0..4 { … }`");
    }
    if joint('+') {
        return Some("write `i += 1`");
    }
    // `--x` is a double negation in Rust.
    if joint('-') && (tokens.len() == 2 || is_punct(tokens.get(2), ';')) {
        return Some("write `i -= 1`");
    }
    let is_type = ident(0).is_some_and(|name| foreign_names::rust_type(&name).is_some());
    if (is_type && ident(1).is_some() || ident(0).as_deref() == Some("var")) && is_punct(tokens.get(2), '=') {
        return Some("declare variables with `let x = …;`, or `let mut x = …;` to change them later");
    }
    None
}
