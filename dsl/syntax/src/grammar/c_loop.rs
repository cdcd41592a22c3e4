//! The head of a `for` loop of C, `(int i = 0; i < n; i++)`, as a range of Rust.
//!
//! Input: tokens that are not Rust. Output: the help with the range; a loop that is no range has an example with its variable.

use proc_macro2::{Spacing, TokenStream, TokenTree};

use super::cursor::is_punct;
use crate::token_limits;

/// Returns the help for a loop with this head.
pub(super) fn range(head: &TokenStream) -> String {
    let tokens: Vec<TokenTree> = head.clone().into_iter().collect();
    let parts: Vec<&[TokenTree]> = tokens.split(|token| is_punct(Some(token), ';')).collect();
    let whole = match parts.as_slice() {
        [start, condition, step] => whole_range(start, condition, step),
        _ => None,
    };
    match whole {
        Some((name, range)) => format!("write `for {name} in {range} {{ … }}`"),
        None => "write `for i in 0..4 { … }`: the step of a range is 1, and `(0..4).rev()` counts down".to_owned(),
    }
}

/// Returns the variable of the loop and its range; `None`: it has another step than 1, or another shape.
fn whole_range(start: &[TokenTree], condition: &[TokenTree], step: &[TokenTree]) -> Option<(String, String)> {
    let equals = start.iter().position(|token| is_punct(Some(token), '='))?;
    let (TokenTree::Ident(name), from) = (start.get(equals.checked_sub(1)?)?, start.get(equals + 1..)?) else {
        return None;
    };
    let (first, rest) = condition.split_first()?;
    let is_name = |token: &TokenTree| matches!(token, TokenTree::Ident(other) if other == name);
    let (TokenTree::Punct(comparison), true) = (rest.first()?, is_name(first)) else { return None };
    let is_inclusive = comparison.spacing() == Spacing::Joint && is_punct(rest.get(1), '=');
    let to = rest.get(1 + usize::from(is_inclusive)..)?;
    let (from_source, to_source) = (source(from), source(to));
    if from_source.is_empty() || to_source.is_empty() {
        return None;
    }
    let range = match (comparison.as_char(), sign_of_step(step, &is_name)?, is_inclusive) {
        ('<', '+', false) => format!("{from_source}..{to_source}"),
        ('<', '+', true) => format!("{from_source}..={to_source}"),
        ('>', '-', true) => match without_minus_one(from) {
            Some(count) => format!("({to_source}..{count}).rev()"),
            None => format!("({to_source}..={from_source}).rev()"),
        },
        ('>', '-', false) => format!("({to_source} + 1..={from_source}).rev()"),
        _ => return None,
    };
    Some((name.to_string(), range))
}

/// Returns the sign of `i++`, `++i`, `i += 1`, or of the same with a minus.
fn sign_of_step(step: &[TokenTree], is_name: &dyn Fn(&TokenTree) -> bool) -> Option<char> {
    let sign = ['+', '-'].into_iter().find(|sign| step.iter().any(|token| is_punct(Some(token), *sign)))?;
    let is_sign = |token: &TokenTree| is_punct(Some(token), sign);
    let is_one = |token: &TokenTree| token.to_string() == "1";
    let is_step = match step {
        [name, a, b] if is_name(name) => is_sign(a) && is_sign(b),
        [a, b, name] => is_sign(a) && is_sign(b) && is_name(name),
        [name, a, equals, one] => is_name(name) && is_sign(a) && is_punct(Some(equals), '=') && is_one(one),
        _ => false,
    };
    is_step.then_some(sign)
}

/// Returns `n` of `n - 1`.
fn without_minus_one(tokens: &[TokenTree]) -> Option<String> {
    match tokens {
        [count @ .., minus, one] if is_punct(Some(minus), '-') && one.to_string() == "1" && !count.is_empty() => {
            Some(source(count))
        }
        _ => None,
    }
}

/// Returns the place at the end of these tokens: a name with fields and elements, as `i` or `v.x`.
pub(super) fn place_before(tokens: &[TokenTree]) -> Option<String> {
    let mut begin = tokens.len();
    while let Some(at) = begin.checked_sub(1).filter(|at| is_part(tokens.get(*at))) {
        let is_ident = |at: usize| matches!(tokens.get(at), Some(TokenTree::Ident(_)));
        // `return i`
        if is_ident(at) && is_ident(begin) {
            break;
        }
        begin = at;
    }
    place(tokens.get(begin..)?)
}

/// Returns the place at the beginning of these tokens.
pub(super) fn place_after(tokens: &[TokenTree]) -> Option<String> {
    let end = tokens.iter().position(|token| !is_part(Some(token))).unwrap_or(tokens.len());
    place(tokens.get(..end)?)
}

fn is_part(token: Option<&TokenTree>) -> bool {
    match token {
        Some(TokenTree::Ident(_)) => true,
        Some(TokenTree::Group(group)) => group.delimiter() == proc_macro2::Delimiter::Bracket,
        other => is_punct(other, '.'),
    }
}

fn place(tokens: &[TokenTree]) -> Option<String> {
    matches!(tokens.first(), Some(TokenTree::Ident(_))).then(|| source(tokens))
}

fn source(tokens: &[TokenTree]) -> String {
    token_limits::compact(&token_limits::spaced(&tokens.iter().cloned().collect()))
}
