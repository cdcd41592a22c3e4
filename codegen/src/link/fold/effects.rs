//! Decides whether code has side effects.
//!
//! Input: tokens of a function, or the name of a built-in function. Output: whether it discards, or writes to anything but local
//! variables. Loops are assumed to end; a read is not a side effect.

use super::locals::{KEYWORDS, Locals};
use crate::link::token::{Token, TokenKind};

/// Tests whether a function has side effects, ignoring those of the functions that it calls.
pub(in crate::link) fn has_effects(tokens: &[Token<'_>]) -> bool {
    let locals = Locals::of(tokens);
    let is_write = |index: usize| writes(tokens, index) && !is_local_write(tokens, &locals, index);
    let is_built_in = |token: &Token<'_>| token.kind == TokenKind::Name && built_in_has_effects(token.text);
    (0..tokens.len()).any(|index| is_write(index) || is_built_in(&tokens[index]))
}

/// Tests whether a call of a built-in function has side effects.
pub(super) fn built_in_has_effects(name: &str) -> bool {
    let is_atomic = name.starts_with("atomic") && !matches!(name, "atomic" | "atomicLoad");
    is_atomic
        || name == "discard"
        || name == "textureStore"
        || name.ends_with("Barrier")
        || name.starts_with("workgroupUniform")
}

/// Tests whether the token at `index` is an assignment, an increment or a decrement.
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

/// Tests whether the write at `index` is a declaration, or changes a local variable. A statement that does not begin with the name of a
/// variable can write through a pointer.
fn is_local_write(tokens: &[Token<'_>], locals: &Locals<'_>, index: usize) -> bool {
    let first = target(tokens, index);
    let name = tokens[first].text;
    name == "_" || KEYWORDS.contains(&name) || locals.at(name, first).is_some_and(|local| local.keyword == "var")
}

/// Returns the first token of the statement that contains `index`.
fn target(tokens: &[Token<'_>], index: usize) -> usize {
    let before = tokens[..index].iter().rposition(|token| matches!(token.text, ";" | "{" | "}"));
    let start = before.map_or(0, |before| before + 1);
    // The header of a loop: `for (var index = ...`.
    if tokens[start].text == "for" { (start + 2).min(index) } else { start }
}
