//! Syntax of GLSL, HLSL and WGSL in closures, and what Rust has instead.
//!
//! Input: tokens that are not Rust. Output: the help of the error, if they look like another language.

use std::borrow::Cow;

use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};

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

/// Returns the `?` of the first `condition ? a : b`, and the help with the `if` of Rust.
pub(super) fn ternary(tokens: &TokenStream) -> Option<(Span, Cow<'static, str>)> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let inside = |token: &TokenTree| match token {
        TokenTree::Group(group) => ternary(&group.stream()),
        _ => None,
    };
    if let Some(found) = tokens.iter().find_map(inside) {
        return Some(found);
    }
    let question = tokens.iter().position(|token| is_punct(Some(token), '?'))?;
    let span = tokens.get(question).map(TokenTree::span)?;
    let begin = (0..question).rev().find(|at| is_before_condition(&tokens, *at)).map_or(0, |at| at + 1);
    let rest = tokens.get(begin..)?;
    let is_end = |token: &TokenTree| is_punct(Some(token), ';') || is_punct(Some(token), ',');
    let end = rest.iter().position(is_end).unwrap_or(rest.len());
    let branch = branches(rest.get(..end)?)?;
    let help = if branch.chars().count() > LONGEST {
        "write `if … { … } else { … }`".into()
    } else {
        format!("write `{branch}`")
    };
    Some((span, help.into()))
}

/// The greatest length of an `if` that a help repeats, in characters.
const LONGEST: usize = 240;

/// Returns the `if` for `condition ? a : b`; `b` may be a further one. `None`: the tokens are no such expression.
fn branches(tokens: &[TokenTree]) -> Option<String> {
    let question = tokens.iter().position(|token| is_punct(Some(token), '?'))?;
    let (condition, rest) = (tokens.get(..question)?, tokens.get(question + 1..)?);
    let mut depth = 0;
    let colon = rest.iter().enumerate().position(|(at, token)| {
        depth += usize::from(is_punct(Some(token), '?'));
        let is_path = is_punct(rest.get(at + 1), ':') || at > 0 && is_punct(rest.get(at - 1), ':');
        let is_colon = is_punct(Some(token), ':') && !is_path;
        let is_own = is_colon && depth == 0;
        depth = depth.saturating_sub(usize::from(is_colon));
        is_own
    })?;
    let condition = match condition {
        // `(a < b) ? …`: the brackets of the condition are no part of it in Rust.
        [TokenTree::Group(group)] if group.delimiter() == Delimiter::Parenthesis => source(&group.stream()),
        condition => source(&condition.iter().cloned().collect()),
    };
    let value = |tokens: &[TokenTree]| branches(tokens).unwrap_or_else(|| source(&tokens.iter().cloned().collect()));
    let (then, other) = (rest.get(..colon)?, rest.get(colon + 1..)?);
    let (then, is_chain, other) = (value(then), branches(other).is_some(), value(other));
    if condition.is_empty() || then.is_empty() || other.is_empty() {
        return None;
    }
    let other = if is_chain { other } else { format!("{{ {other} }}") };
    Some(format!("if {condition} {{ {then} }} else {other}"))
}

fn source(tokens: &TokenStream) -> String {
    token_limits::compact(&token_limits::spaced(tokens))
}

/// Whether the condition of `condition ? a : b` follows the token at `at`: it is `=`, `return`, the end of a statement or of an argument,
/// or the end of a closure's parameters.
fn is_before_condition(tokens: &[TokenTree], at: usize) -> bool {
    let before = at.checked_sub(1).and_then(|before| tokens.get(before));
    let is_joint = |characters: &str| matches!(before, Some(TokenTree::Punct(punct)) if punct.spacing() == Spacing::Joint && characters.contains(punct.as_char()));
    match tokens.get(at) {
        Some(TokenTree::Punct(punct)) => match punct.as_char() {
            ';' | ',' => true,
            '=' => punct.spacing() == Spacing::Alone && !is_joint("=<>!"),
            '|' => punct.spacing() == Spacing::Alone && !is_joint("|"),
            _ => false,
        },
        Some(TokenTree::Ident(word)) => word == "return",
        Some(TokenTree::Group(group)) => group.delimiter() == Delimiter::Brace,
        _ => false,
    }
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
