//! The grammar of a description: one buffer, and the items in its braces.
//!
//! Input: tokens without documentation comments. Output: a [`RawDescription`], whose functions are not type-checked.
//! After an error, parsing continues after the next `;` or `{ … }` of the same level, so that all errors of a description
//! are reported together.

mod blocks;
mod c_syntax;
mod choices;
mod closures;
mod cursor;
mod items;
mod recovery;

pub(crate) use choices::from_builder as choice_from_builder;
pub(crate) use closures::{whole_closure, whole_helper};

use fragbuf_model::{Diagnostic, SourceSpan, Spanned, codes};
use proc_macro2::{Group, TokenStream};

use crate::items::RawDescription;
use crate::names;
use crate::report::{FIRST, Report};
use cursor::Cursor;

/// Parses a whole description: `buffer Name from preset { … }`.
pub(crate) fn description(tokens: TokenStream, report: &mut Report) -> Option<RawDescription> {
    let mut cursor = Cursor::new(tokens);
    find_buffer(&mut cursor, report)?;
    let start = cursor.source_span(report);
    cursor.take_keyword("buffer");
    let name = name_of_buffer(&mut cursor, report);
    let preset = preset(&mut cursor, report);
    let body = body(&mut cursor, report)?;
    let items = items::items(&mut Cursor::inside(&body), report);
    after_buffer(&cursor, &start, report);
    Some(RawDescription { name, preset, items })
}

/// Moves to the keyword `buffer`.
fn find_buffer(cursor: &mut Cursor, report: &mut Report) -> Option<()> {
    const SHAPE: &str = "start with `buffer Name { … }`";
    if cursor.at_keyword("buffer") {
        return Some(());
    }
    let (span, found) = (cursor.source_span(report), cursor.describe());
    while !cursor.is_done() && !cursor.at_keyword("buffer") {
        cursor.take();
    }
    if cursor.is_done() {
        report.error(codes::MISSING_BUFFER, &span, format!("expected `buffer`, found {found}"), SHAPE);
        return None;
    }
    report.error(codes::UNEXPECTED_TOKEN, &span, format!("unexpected {found} before `buffer`"), SHAPE);
    Some(())
}

fn name_of_buffer(cursor: &mut Cursor, report: &mut Report) -> Spanned<String> {
    let span = cursor.source_span(report);
    let name = if cursor.at_keyword("from") { None } else { cursor.take_identifier() };
    let Some(name) = name else {
        let message = format!("expected a buffer name, found {}", cursor.describe());
        report.error(codes::UNEXPECTED_TOKEN, &span, message, "write `buffer Name { … }`");
        return Spanned::new("Unnamed".to_string(), span);
    };
    let name = names::written(&name, report);
    names::buffer(&name, report)
}

fn preset(cursor: &mut Cursor, report: &mut Report) -> Option<Spanned<String>> {
    if !cursor.take_keyword("from") {
        return None;
    }
    let span = cursor.source_span(report);
    match cursor.take_identifier() {
        Some(name) => Some(Spanned::new(name.to_string(), span)),
        None => {
            let message = format!("expected a technique name after `from`, found {}", cursor.describe());
            report.error(codes::UNEXPECTED_TOKEN, &span, message, "for example `from kplus_array`");
            None
        }
    }
}

fn body(cursor: &mut Cursor, report: &mut Report) -> Option<Group> {
    if let Some(group) = cursor.take_braces() {
        return Some(group);
    }
    cursor.expected("`{`", "write `buffer Name from preset { … }`", report);
    loop {
        if let Some(group) = cursor.take_braces() {
            return Some(group);
        }
        cursor.take()?;
    }
}

fn after_buffer(cursor: &Cursor, first: &SourceSpan, report: &mut Report) {
    if cursor.is_done() {
        return;
    }
    let span = cursor.source_span(report);
    if cursor.at_keyword("buffer") {
        let message = "expected one buffer, found a second";
        let diagnostic = Diagnostic::new(codes::DUPLICATE, &span, message, "put each buffer into a separate file");
        report.push(diagnostic.label(first, FIRST));
    } else {
        let message = format!("unexpected {} after the buffer", cursor.describe());
        report.error(codes::UNEXPECTED_TOKEN, &span, message, "move it into the buffer's braces, or remove it");
    }
}
