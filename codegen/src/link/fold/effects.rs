//! Decides whether code has side effects.
//!
//! In: tokens of a function, or the name of a built-in function. Out: whether it writes to anything but local variables, or
//! discards. Loops are assumed to end; no read is a side effect.

use super::locals::{KEYWORDS, Locals};
use crate::link::token::{Token, TokenKind};

/// Whether a function has effects of its own; those of the functions that it calls are left out.
pub(in crate::link) fn has_effects(tokens: &[Token<'_>]) -> bool {
    let locals = Locals::of(tokens);
    let is_write = |index: usize| writes(tokens, index) && !stays_inside(tokens, &locals, index);
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

/// Whether the write at `index` is a declaration, or changes a local variable. What begins with anything but the name of a
/// variable may write through a pointer.
fn stays_inside(tokens: &[Token<'_>], locals: &Locals<'_>, index: usize) -> bool {
    let first = target(tokens, index);
    let name = tokens[first].text;
    name == "_" || KEYWORDS.contains(&name) || locals.at(name, first).is_some_and(|local| local.keyword == "var")
}

/// The first token of the statement that holds `index`.
fn target(tokens: &[Token<'_>], index: usize) -> usize {
    let before = tokens[..index].iter().rposition(|token| matches!(token.text, ";" | "{" | "}"));
    let start = before.map_or(0, |before| before + 1);
    // The head of a loop: `for (var index = ...`.
    if tokens[start].text == "for" { (start + 2).min(index) } else { start }
}
