//! The blocks `fragment { name: format, … }` and `uniform { name: type, … }`.
//!
//! Input: a block in braces. Output: its declarations as written.

use fragbuf_model::Spanned;

use super::cursor::Cursor;
use crate::declarations::Declaration;
use crate::names;
use crate::report::{Report, Stop};

/// Parses a block in braces; `shape` is an example of it.
pub(super) fn declarations(cursor: &mut Cursor, shape: &str, report: &mut Report) -> Result<Vec<Declaration>, Stop> {
    let Some(group) = cursor.take_braces() else {
        return Err(cursor.expected("`{`", format!("write `{shape}`"), report));
    };
    cursor.take_punct(';');
    let mut inner = Cursor::inside(&group);
    let mut rows = Vec::new();
    while !inner.is_done() {
        match declaration(&mut inner, shape, report) {
            Ok(row) => rows.push(row),
            Err(Stop) => inner.skip_past_comma(),
        }
    }
    Ok(rows)
}

fn declaration(cursor: &mut Cursor, shape: &str, report: &mut Report) -> Result<Declaration, Stop> {
    let help = || format!("write `{shape}`");
    let Some(name) = cursor.take_identifier() else { return Err(cursor.expected("a name", help(), report)) };
    let name = names::written(&name, report);
    if !cursor.take_punct(':') {
        return Err(cursor.expected("`:`", help(), report));
    }
    let span = cursor.source_span(report);
    let Some(type_name) = cursor.take_identifier() else { return Err(cursor.expected("a type", help(), report)) };
    let type_name = Spanned::new(type_name.to_string(), span);
    if !cursor.take_punct(',') && !cursor.is_done() {
        return Err(cursor.expected("`,`", help(), report));
    }
    Ok(Declaration { name, type_name })
}
