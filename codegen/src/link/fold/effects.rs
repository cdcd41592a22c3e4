//! Decides whether code has side effects.
//!
//! In: tokens of a function, or the name of a built-in function. Out: whether it writes to anything but local variables, or
//! discards. Loops are assumed to end; no read is a side effect.

use std::collections::BTreeSet;

use crate::link::token::{Token, TokenKind};

/// Whether a function has effects of its own; those of the functions that it calls are left out.
pub(super) fn has_effects(tokens: &[Token<'_>]) -> bool {
    let locals: BTreeSet<&str> = declared(tokens, &["var", "let", "const"]).chain(["_"]).collect();
    let is_write = |index: usize| writes(tokens, index) && !locals.contains(target(tokens, index));
    let is_built_in = |token: &Token<'_>| token.kind == TokenKind::Name && built_in_has_effects(token.text);
    (0..tokens.len()).any(|index| is_write(index) || is_built_in(&tokens[index]))
}

/// Whether a call of WGSL's own function does more than return a value.
pub(super) fn built_in_has_effects(name: &str) -> bool {
    let is_atomic = name.starts_with("atomic") && !matches!(name, "atomic" | "atomicLoad");
    is_atomic
        || name == "discard"
        || name == "textureStore"
        || name.ends_with("Barrier")
        || name.starts_with("workgroupUniform")
}

/// The names declared behind these keywords, in order.
pub(super) fn declared<'a>(tokens: &'a [Token<'a>], keywords: &'a [&str]) -> impl Iterator<Item = &'a str> {
    let pairs = tokens.windows(2).filter(|pair| keywords.contains(&pair[0].text) && pair[1].kind == TokenKind::Name);
    pairs.map(|pair| pair[1].text)
}

/// Whether an assignment, an increment or a decrement stands at `index`.
fn writes(tokens: &[Token<'_>], index: usize) -> bool {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text);
    let joins = |at: usize| at > 0 && tokens[at - 1].at + 1 == tokens[at].at;
    match tokens[index].text {
        "=" => {
            let before = if joins(index) { text(index - 1) } else { "" };
            // `<<=` and `>>=` assign, `<=` and `>=` compare.
            let shifts = matches!(before, "<" | ">") && index > 1 && joins(index - 1) && text(index - 2) == before;
            let compares = matches!(before, "=" | "!") || (matches!(before, "<" | ">") && !shifts);
            let begins = text(index + 1) == "=" && tokens[index].at + 1 == tokens[index + 1].at;
            !compares && !begins
        }
        sign @ ("+" | "-") => joins(index) && text(index - 1) == sign,
        _ => false,
    }
}

/// The first name of the statement that holds `index`; a declaration is no write, and counts as one of a local.
fn target<'a>(tokens: &[Token<'a>], index: usize) -> &'a str {
    let start = tokens[..index].iter().rposition(|token| matches!(token.text, ";" | "{" | "}"));
    let mut statement = tokens[start.map_or(0, |start| start + 1)..=index].iter();
    let mut first = statement.next().map_or("", |token| token.text);
    // The head of a loop: `for (var index = ...`.
    if first == "for" {
        first = statement.nth(1).map_or("", |token| token.text);
    }
    match first {
        "var" | "let" => statement.next().map_or("", |token| token.text),
        _ => first,
    }
}
