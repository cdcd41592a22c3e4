//! Limits on tokens, so that no description exhausts the stack of a parser.
//!
//! Input: tokens. Output: the same tokens without documentation comments, with invisible groups made visible, or an error.
//! Brackets may nest [`DEPTH`] deep. A statement may have [`LENGTH`] tokens, including those of
//! the statements that enclose it: a chain of operators nests as deep as it is long.

use fragbuf_model::codes;
use proc_macro2::{Delimiter, Group, Spacing, Span, TokenStream, TokenTree};

use crate::report::Report;

/// The maximum nesting depth of brackets.
const DEPTH: usize = 40;

/// The maximum number of tokens of a statement.
pub(crate) const LENGTH: usize = 600;

/// Returns the tokens without documentation comments, unless their brackets nest too deep.
pub(crate) fn bounded(tokens: TokenStream, report: &mut Report) -> Option<TokenStream> {
    if let Some(span) = too_deep(tokens.clone()) {
        let span = report.at(span);
        let message = format!("brackets are nested more than {DEPTH} deep");
        report.error(codes::UNSUPPORTED, &span, message, "name the inner parts with `let`");
        return None;
    }
    Some(without_docs(tokens))
}

/// Returns the first bracket that is too deep. Uses an explicit stack, because the nesting of the input is unbounded.
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

/// Removes `/// …` and `//! …`, which the lexer turns into `#[doc = "…"]`.
fn without_docs(tokens: TokenStream) -> TokenStream {
    let all: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::with_capacity(all.len());
    let mut rest = all.as_slice();
    while let Some((first, after)) = rest.split_first() {
        if let Some(after_doc) = after_doc(rest) {
            rest = after_doc;
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

/// Returns the only token of a group. `macro_rules` wraps the token of a `$name:literal` in such a group.
fn single(group: &Group) -> Option<TokenTree> {
    let mut tokens = group.stream().into_iter();
    let first = tokens.next().filter(|token| !matches!(token, TokenTree::Group(_)))?;
    tokens.next().is_none().then_some(first)
}

/// Returns the tokens after a leading documentation comment.
fn after_doc(tokens: &[TokenTree]) -> Option<&[TokenTree]> {
    let rest = after_punct(tokens, '#')?;
    let rest = after_punct(rest, '!').unwrap_or(rest);
    match rest.split_first() {
        Some((TokenTree::Group(group), after)) if group.delimiter() == Delimiter::Bracket => {
            let is_doc = matches!(group.stream().into_iter().next(), Some(TokenTree::Ident(name)) if name == "doc");
            is_doc.then_some(after)
        }
        _ => None,
    }
}

fn after_punct(tokens: &[TokenTree], character: char) -> Option<&[TokenTree]> {
    match tokens.split_first() {
        Some((TokenTree::Punct(punct), rest)) if punct.as_char() == character => Some(rest),
        _ => None,
    }
}

/// Returns the first token beyond the allowed length of a statement.
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

/// Returns whether a token after `}` continues the expression before it.
fn continues(token: &TokenTree) -> bool {
    match token {
        TokenTree::Ident(keyword) => keyword == "else" || keyword == "as",
        TokenTree::Punct(_) => true,
        TokenTree::Group(_) | TokenTree::Literal(_) => false,
    }
}

/// Returns the user's tokens, separated by single spaces.
pub(crate) fn spaced(tokens: &TokenStream) -> String {
    let mut out = String::new();
    write_spaced(tokens, &mut out);
    out.trim_end().to_string()
}

/// Removes the spaces that are not usual from tokens separated by spaces.
pub(crate) fn compact(spaced: &str) -> String {
    let mut out = String::with_capacity(spaced.len());
    for token in spaced.split(' ') {
        let last = out.chars().next_back();
        let is_word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ')';
        let is_joined = matches!(token, "." | "," | ";" | ")" | "]" | "::" | "..")
            || matches!(last, None | Some('(' | '[' | '.'))
            || out.ends_with("::")
            || (matches!(token, "(" | "[") && last.is_some_and(is_word) && !out.ends_with(" if"));
        if !is_joined {
            out.push(' ');
        }
        out.push_str(token);
    }
    // A sign belongs to its operand.
    if let Some(rest) = out.strip_prefix("- ") { format!("-{rest}") } else { out }
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
