//! The blocks `fragment { name: format, … }` and `uniform { name: type, … }`.
//!
//! Input: a block in braces. Output: its declarations as written.

use fragbuf_model::{Format, Spanned};
use proc_macro2::TokenTree;

use super::cursor::Cursor;
use crate::declarations::Declaration;
use crate::report::{Report, Stop};
use crate::{foreign_names, names};

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
        // In other languages the type is first.
        let help = match cursor.peek() {
            Some(TokenTree::Ident(second)) if is_type(&name.value) => format!("write `{second}: {}`", name.value),
            Some(TokenTree::Ident(second)) => format!("write `{}: {second}`", name.value),
            _ => help(),
        };
        return Err(cursor.expected("`:`", help, report));
    }
    let span = cursor.source_span(report);
    let Some(type_name) = cursor.take_identifier() else { return Err(cursor.expected("a type", help(), report)) };
    let type_name = Spanned::new(type_name.to_string(), span);
    if !cursor.take_punct(',') && !cursor.is_done() {
        let (name, ty) = (&name.value, &type_name.value);
        let help = match cursor.peek() {
            _ if cursor.at_punct('<') => format!("write `{name}: {ty}`, without the type of the components"),
            _ if cursor.at_punct('=') => format!("write `{name}: {ty}`: a declaration has no value"),
            _ => format!("separate declarations by commas: `{name}: {ty}, …`"),
        };
        return Err(cursor.expected("`,`", help, report));
    }
    Ok(Declaration { name, type_name })
}

/// Whether a name is a type of this or another language.
fn is_type(name: &str) -> bool {
    Format::ALL.iter().any(|format| format.keyword() == name) || foreign_names::attribute_format(name).is_some()
}
