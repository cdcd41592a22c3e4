//! Bounds on nesting, so that no description can exhaust the stack of whoever reads it.
//!
//! In: tokens. Out: the same tokens without documentation comments, invisible groups made visible, or a mistake. Brackets may nest [`DEPTH`] deep; a
//! statement may have [`LENGTH`] tokens, counted together with the statements around it, because operators nest too.

use fragbuf_model::codes;
use proc_macro2::{Delimiter, Group, Spacing, Span, TokenStream, TokenTree};

use crate::report::Report;

/// How deep brackets may nest.
const DEPTH: usize = 40;

/// How many tokens a statement may have.
const LENGTH: usize = 600;

/// The tokens, if their brackets nest no deeper than allowed; documentation comments are left out.
pub(crate) fn bounded(tokens: TokenStream, report: &mut Report) -> Option<TokenStream> {
    if let Some(span) = too_deep(tokens.clone()) {
        let origin = report.at(span);
        let message = format!("brackets nest more than {DEPTH} deep");
        report.error(codes::UNSUPPORTED, &origin, message, "name the inner parts with `let`");
        return None;
    }
    Some(without_docs(tokens))
}

/// The first bracket that is too deep. Keeps its own stack: the tokens may be as deep as they like.
fn too_deep(tokens: TokenStream) -> Option<Span> {
    let mut stack = vec![tokens.into_iter()];
    while let Some(top) = stack.last_mut() {
        match top.next() {
            None => drop(stack.pop()),
            Some(TokenTree::Group(group)) => {
                if stack.len() > DEPTH {
                    return Some(group.span_open());
                }
                stack.push(group.stream().into_iter());
            }
            Some(_) => {}
        }
    }
    None
}

/// Leaves out `/// …` and `//! …`, which the lexer turns into `#[doc = "…"]`.
fn without_docs(tokens: TokenStream) -> TokenStream {
    let all: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::with_capacity(all.len());
    let mut rest = all.as_slice();
    while let Some((first, after)) = rest.split_first() {
        if let Some(past) = past_doc(rest) {
            rest = past;
            continue;
        }
        kept.push(match first {
            TokenTree::Group(group) => match (group.delimiter(), single(group)) {
                (Delimiter::None, Some(token)) => token,
                (delimiter, _) => {
                    let delimiter = if delimiter == Delimiter::None { Delimiter::Parenthesis } else { delimiter };
                    let mut inner = Group::new(delimiter, without_docs(group.stream()));
                    inner.set_span(group.span());
                    inner.into()
                }
            },
            other => other.clone(),
        });
        rest = after;
    }
    kept.into_iter().collect()
}

/// The only token of a group: what `macro_rules` put in for `$name:literal` comes so.
fn single(group: &Group) -> Option<TokenTree> {
    let mut tokens = group.stream().into_iter();
    let first = tokens.next().filter(|token| !matches!(token, TokenTree::Group(_)))?;
    tokens.next().is_none().then_some(first)
}

fn past_doc(tokens: &[TokenTree]) -> Option<&[TokenTree]> {
    let rest = after_sign(tokens, '#')?;
    let rest = after_sign(rest, '!').unwrap_or(rest);
    match rest.split_first() {
        Some((TokenTree::Group(group), past)) if group.delimiter() == Delimiter::Bracket => {
            let is_doc = matches!(group.stream().into_iter().next(), Some(TokenTree::Ident(word)) if word == "doc");
            is_doc.then_some(past)
        }
        _ => None,
    }
}

fn after_sign(tokens: &[TokenTree], sign: char) -> Option<&[TokenTree]> {
    match tokens.split_first() {
        Some((TokenTree::Punct(punct), rest)) if punct.as_char() == sign => Some(rest),
        _ => None,
    }
}

/// Where a closure's or function's statements become too long to be read safely.
pub(crate) fn too_long(tokens: &TokenStream) -> Option<Span> {
    longest(tokens, 0)
}

fn longest(tokens: &TokenStream, before: usize) -> Option<Span> {
    let mut length = before;
    let mut tokens = tokens.clone().into_iter().peekable();
    while let Some(token) = tokens.next() {
        length += 1;
        if length > LENGTH {
            return Some(token.span());
        }
        match &token {
            TokenTree::Punct(punct) if punct.as_char() == ';' => length = before,
            TokenTree::Group(group) => {
                if let Some(span) = longest(&group.stream(), length) {
                    return Some(span);
                }
                let statement = group.delimiter() == Delimiter::Brace;
                if statement && !tokens.peek().is_some_and(continues) {
                    length = before;
                }
            }
            _ => {}
        }
    }
    None
}

/// Whether a token after `}` continues the expression that ended there.
fn continues(token: &TokenTree) -> bool {
    match token {
        TokenTree::Ident(word) => word == "else" || word == "as",
        TokenTree::Punct(_) => true,
        TokenTree::Group(_) | TokenTree::Literal(_) => false,
    }
}

/// The user's tokens, separated by single spaces.
pub(crate) fn spaced(tokens: &TokenStream) -> String {
    let mut out = String::new();
    write_spaced(tokens, &mut out);
    out.trim_end().to_string()
}

fn write_spaced(tokens: &TokenStream, out: &mut String) {
    for token in tokens.clone() {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("( ", ") "),
                    Delimiter::Brace => ("{ ", "} "),
                    Delimiter::Bracket => ("[ ", "] "),
                    Delimiter::None => ("", ""),
                };
                out.push_str(open);
                write_spaced(&group.stream(), out);
                out.push_str(close);
            }
            TokenTree::Punct(punct) => {
                out.push(punct.as_char());
                if punct.spacing() == Spacing::Alone {
                    out.push(' ');
                }
            }
            other => {
                out.push_str(&other.to_string());
                out.push(' ');
            }
        }
    }
}
