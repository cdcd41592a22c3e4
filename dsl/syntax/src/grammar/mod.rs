//! The grammar of a description: one buffer, and the items in its braces.
//!
//! In: tokens without documentation comments. Out: a [`Draft`] without its closures' meaning checked by anyone but
//! [`crate::functions`]. After a mistake, reading goes on behind the next `;` or `{ … }` of the same level, so that all
//! mistakes of a description come at once.

mod blocks;
mod choices;
mod closures;
mod cursor;
mod items;
mod names;

pub(crate) use blocks::Row;
pub(crate) use choices::given as given_choice;
pub(crate) use closures::{RawFunction, RawParameter, whole_closure, whole_helper};
pub use closures::{Role, Written};
pub(crate) use items::Items;
pub(crate) use names::{buffer as buffer_name, word};

use fragbuf_model::{Diagnostic, Draft, Origin, Spanned, codes};
use proc_macro2::{Group, TokenStream};

use crate::functions;
use crate::report::Report;
use cursor::Cursor;

/// A mistake was reported; the rest of the item is not worth reading.
pub(crate) struct Stop;

/// The whole text: `buffer Name from preset { … }`.
pub(crate) fn description(tokens: TokenStream, report: &mut Report) -> Option<(Draft, Vec<Written>)> {
    let mut cursor = Cursor::new(tokens);
    find_buffer(&mut cursor, report)?;
    let start = cursor.origin(report);
    cursor.word("buffer");
    let name = name_of_buffer(&mut cursor, report);
    let preset = preset(&mut cursor, report);
    let body = body(&mut cursor, report)?;
    let mut items = Items::default();
    items.read(&mut Cursor::inside(&body), report);
    after_buffer(&cursor, &start, report);
    let written = std::mem::take(&mut items.written);
    Some((functions::finish(name, preset, items, report), written))
}

/// Goes to the word `buffer`.
fn find_buffer(cursor: &mut Cursor, report: &mut Report) -> Option<()> {
    const SHAPE: &str = "begin with `buffer Name { … }`";
    if cursor.at_word("buffer") {
        return Some(());
    }
    let (origin, found) = (cursor.origin(report), cursor.describe());
    while !cursor.is_done() && !cursor.at_word("buffer") {
        cursor.take();
    }
    if cursor.is_done() {
        report.error(codes::MISSING_BUFFER, &origin, "there is no `buffer` here", SHAPE);
        return None;
    }
    report.error(codes::UNEXPECTED, &origin, format!("{found} stands before the buffer"), SHAPE);
    Some(())
}

fn name_of_buffer(cursor: &mut Cursor, report: &mut Report) -> Spanned<String> {
    let origin = cursor.origin(report);
    let word = if cursor.at_word("from") { None } else { cursor.any_word() };
    let Some(word) = word else {
        let message = format!("the buffer's name belongs here, not {}", cursor.describe());
        report.error(codes::UNEXPECTED, &origin, message, "write `buffer Name { … }`");
        return Spanned::new("Unnamed".to_string(), origin);
    };
    let word = names::written(&word, report);
    names::buffer(&word, report)
}

fn preset(cursor: &mut Cursor, report: &mut Report) -> Option<Spanned<String>> {
    if !cursor.word("from") {
        return None;
    }
    let origin = cursor.origin(report);
    match cursor.any_word() {
        Some(word) => Some(Spanned::new(word.to_string(), origin)),
        None => {
            let message = format!("a technique's name belongs after `from`, not {}", cursor.describe());
            report.error(codes::UNEXPECTED, &origin, message, "for example `from kplus_array`");
            None
        }
    }
}

fn body(cursor: &mut Cursor, report: &mut Report) -> Option<Group> {
    if let Some(group) = cursor.braces() {
        return Some(group);
    }
    let message = format!("`{{` belongs here, not {}", cursor.describe());
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, "write `buffer Name from preset { … }`");
    loop {
        if let Some(group) = cursor.braces() {
            return Some(group);
        }
        cursor.take()?;
    }
}

fn after_buffer(cursor: &Cursor, first: &Origin, report: &mut Report) {
    if cursor.is_done() {
        return;
    }
    let origin = cursor.origin(report);
    if cursor.at_word("buffer") {
        let message = "a second buffer is described here";
        let diagnostic = Diagnostic::new(codes::DUPLICATE, &origin, message, "put each buffer into a file of its own");
        report.push(diagnostic.label(first, "the first is here"));
    } else {
        let message = format!("{} stands after the buffer", cursor.describe());
        report.error(codes::UNEXPECTED, &origin, message, "put it inside the buffer's braces, or leave it out");
    }
}
