//! Syntax of C, GLSL, HLSL and WGSL in closures, and what Rust has instead.
//!
//! Input: tokens that are not Rust. Output: the error at the part that another language has, if there is one.

use std::borrow::Cow;

use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};

use super::c_loop;
use super::cursor::is_punct;
use crate::{foreign_names, token_limits};

/// A part that another language has.
pub(super) struct Foreign {
    pub(super) span: Span,
    /// What Rust does not have.
    pub(super) message: Cow<'static, str>,
    /// What Rust has instead.
    pub(super) help: Cow<'static, str>,
}

/// Returns the first part that another language has.
pub(super) fn find(tokens: &TokenStream) -> Option<Foreign> {
    if let Some((span, help)) = ternary(tokens) {
        return Some(Foreign { span, message: "Rust has no operator `? :`".into(), help });
    }
    first(tokens)
}

fn first(tokens: &TokenStream) -> Option<Foreign> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    (0..tokens.len()).find_map(|at| {
        let (before, rest) = tokens.split_at_checked(at)?;
        match rest.first() {
            Some(TokenTree::Group(group)) => first(&group.stream()),
            Some(token) => {
                let (offset, message, help) = pattern(before, rest)?;
                let span = rest.get(offset).unwrap_or(token).span();
                Some(Foreign { span, message, help })
            }
            None => None,
        }
    })
}

/// Returns the `?` of the first `condition ? a : b`, and the help with the `if` of Rust.
fn ternary(tokens: &TokenStream) -> Option<(Span, Cow<'static, str>)> {
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

/// A part of another language: the index of its first token, what Rust does not have, and what it has instead.
type Pattern = (usize, Cow<'static, str>, Cow<'static, str>);

fn pattern(before: &[TokenTree], tokens: &[TokenTree]) -> Option<Pattern> {
    match tokens.first() {
        Some(TokenTree::Ident(word)) if word == "not" => {
            let help = format!("write `!{}`", operand(tokens.get(1..).unwrap_or_default()));
            Some((0, "Rust has no operator `not`".into(), help.into()))
        }
        Some(TokenTree::Ident(word)) if word == "for" => {
            let Some(TokenTree::Group(head)) = tokens.get(1) else { return None };
            // `for (i, f) in …` is Rust.
            let is_rust = matches!(tokens.get(2), Some(TokenTree::Ident(word)) if word == "in");
            let help = c_loop::range(&head.stream());
            (head.delimiter() == Delimiter::Parenthesis && !is_rust)
                .then(|| (0, "a `for` loop of Rust iterates over a range".into(), help.into()))
        }
        _ => step(before, tokens).or_else(|| {
            fixed_pattern(tokens).map(|(at, message, help)| (at, Cow::Borrowed(message), Cow::Borrowed(help)))
        }),
    }
}

/// Returns the pattern of `i++`, `i--` or `++i`.
fn step(before: &[TokenTree], tokens: &[TokenTree]) -> Option<Pattern> {
    let sign = ['+', '-'].into_iter().find(|sign| is_doubled(tokens, *sign))?;
    let place = match tokens.get(2) {
        None => c_loop::place_before(before)?,
        Some(next) if is_punct(Some(next), ';') || is_punct(Some(next), ',') => c_loop::place_before(before)?,
        // `--x` is a double negation in Rust.
        _ if sign == '-' => return None,
        Some(_) => c_loop::place_after(tokens.get(2..)?)?,
    };
    // Components and attributes are floats.
    let one = if place.contains(['.', '[']) { "1.0" } else { "1" };
    let message = format!("Rust has no operator `{sign}{sign}`");
    Some((0, message.into(), format!("write `{place} {sign}= {one}`").into()))
}

/// Whether the first two tokens are this character twice, without a space.
fn is_doubled(tokens: &[TokenTree], character: char) -> bool {
    matches!(tokens.first(), Some(TokenTree::Punct(punct)) if punct.as_char() == character && punct.spacing() == Spacing::Joint)
        && is_punct(tokens.get(1), character)
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

/// Returns a pattern whose message and help are always the same.
fn fixed_pattern(tokens: &[TokenTree]) -> Option<(usize, &'static str, &'static str)> {
    let ident = |at: usize| match tokens.get(at) {
        Some(TokenTree::Ident(name)) => Some(name.to_string()),
        _ => None,
    };
    let parentheses =
        matches!(tokens.get(1), Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
    let is = |at: usize, character: char| is_punct(tokens.get(at), character);
    let generic = ident(0).filter(|_| is(1, '<') && ident(2).is_some() && is(3, '>'));
    if let Some(help) = generic.and_then(|name| foreign_names::generic_constructor(&name)) {
        return Some((0, "the constructors of Rust's vectors have no type in `<…>`", help));
    }
    match ident(0).as_deref() {
        Some("and") => return Some((0, "Rust has no operator `and`", "write `&&`")),
        Some("or") => return Some((0, "Rust has no operator `or`", "write `||`")),
        // A keyword of Rust.
        Some("mod") if parentheses => {
            return Some((0, "Rust has no function `mod`", "write `x - y * (x / y).floor()` for `mod(x, y)`"));
        }
        _ => {}
    }
    // Comparisons of other languages. `=>` is also in a `match`, which is described elsewhere.
    if is_doubled(tokens, '=') && is(2, '=') {
        return Some((0, "Rust has no operator `===`", "write `==`"));
    }
    if is(0, '!') && is(1, '=') && is(2, '=') {
        return Some((0, "Rust has no operator `!==`", "write `!=`"));
    }
    match (is(0, '='), is(0, '<')) {
        (true, _) if is(1, '<') => return Some((0, "Rust has no operator `=<`", "write `<=`")),
        (true, _) if is(1, '!') => return Some((0, "Rust has no operator `=!`", "write `!=`")),
        (_, true) if is(1, '>') => return Some((0, "Rust has no operator `<>`", "write `!=`")),
        _ => {}
    }
    // `.5` after an operator.
    let is_operator = ['<', '>', '=', '+', '-', '*', '/', ','].iter().any(|operator| is(0, *operator));
    if is_operator && is(1, '.') && matches!(tokens.get(2), Some(TokenTree::Literal(_))) {
        return Some((1, "a number of Rust does not begin with its point", "write a digit before the point: `0.5`"));
    }
    let is_type = ident(0).is_some_and(|name| foreign_names::rust_type(&name).is_some());
    if (is_type && ident(1).is_some() || ident(0).as_deref() == Some("var")) && is(2, '=') {
        let help = "declare variables with `let x = …;`, or `let mut x = …;` to change them later";
        return Some((0, "Rust declares variables with `let`", help));
    }
    None
}
