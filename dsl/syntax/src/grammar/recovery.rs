//! The boundaries of items, and where parsing continues after an error.
//!
//! Input: a cursor inside the buffer's braces. Output: the cursor after an item, or at the next one.

use fragbuf_model::codes;
use proc_macro2::{Delimiter, Spacing, TokenTree};

use super::cursor::{Cursor, is_punct};
use crate::report::{Report, Stop};
use crate::token_limits;

/// Takes the `;` after an item. If it is missing and the next item starts here, parsing continues there.
pub(super) fn end_of_item(cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
    end_of_item_or(cursor, "end the item with `;`", report)
}

/// Takes the `;` after an item like [`end_of_item`], with the help for what is there instead.
pub(super) fn end_of_item_or(cursor: &mut Cursor, help: &str, report: &mut Report) -> Result<(), Stop> {
    if cursor.take_punct(';') {
        return Ok(());
    }
    if starts_item(cursor) || cursor.is_done() {
        cursor.missing_semicolon(help, report);
        return Ok(());
    }
    Err(cursor.expected("`;`", help, report))
}

/// Returns the source of the rest of an item, without its `;`.
pub(super) fn source_of_rest(cursor: &Cursor) -> String {
    let is_end = |token: &&TokenTree| is_punct(Some(token), ';');
    let rest = cursor.rest().iter().take_while(|token| !is_end(token)).take(12).cloned().collect();
    token_limits::compact(&token_limits::spaced(&rest))
}

/// Reports `else` after an item that has no alternatives, and takes the rest of the item.
pub(super) fn reject_alternatives(cursor: &mut Cursor, what: &str, help: &str, report: &mut Report) {
    let message = format!("{what} has no alternatives: expected `;`, found `else`");
    report.error(codes::UNEXPECTED_TOKEN, &cursor.source_span(report), message, help);
    while !cursor.is_done() && !cursor.take_punct(';') {
        cursor.take();
        if starts_item(cursor) {
            return;
        }
    }
}

/// Returns whether the next tokens can only start a new item.
pub(super) fn starts_item(cursor: &Cursor) -> bool {
    match (cursor.peek(), cursor.peek_second()) {
        (Some(TokenTree::Ident(keyword)), second) => match keyword.to_string().as_str() {
            "where" | "fn" => true,
            "keep" => match second {
                Some(TokenTree::Ident(all)) => all == "all",
                other => matches!(other, Some(TokenTree::Literal(_))),
            },
            "fragment" | "uniform" => matches!(second, Some(TokenTree::Group(_))),
            // `texture(…)` is a call of another language.
            "texture" => matches!(second, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace),
            "image" => matches!(second, Some(TokenTree::Ident(_))),
            "resolve" | "between" => is_punct(second, '|') || is_single_colon(second),
            _ => is_single_colon(second),
        },
        _ => false,
    }
}

fn is_single_colon(token: Option<&TokenTree>) -> bool {
    matches!(token, Some(TokenTree::Punct(punct))
        if punct.as_char() == ':' && punct.spacing() == Spacing::Alone)
}

/// Moves after the next `;` or `{ … }`, or to the next item, and always beyond position `before`.
pub(super) fn recover(cursor: &mut Cursor, before: usize) {
    while cursor.position() == before || !starts_item(cursor) {
        let Some(token) = cursor.take() else { return };
        if is_punct(Some(&token), ';') {
            return;
        }
        if matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace) {
            cursor.take_punct(';');
            return;
        }
    }
}
