//! The blocks `fragment { name: format, … }` and `uniform { name: type, … }`.
//!
//! In: a block in braces. Out: its rows, each name once. Formats and types are the model's.

use super::cursor::Cursor;
use super::{Stop, names};
use crate::near;
use crate::report::Report;
use fragbuf_model::{Attribute, Diagnostic, Format, Spanned, Uniform, UniformType, codes};

/// `name: word`, both as written.
pub(crate) struct Row {
    pub name: Spanned<String>,
    pub word: Spanned<String>,
}

/// The rows of the block in braces that belongs here; `shape` is an example of it.
pub(crate) fn rows(cursor: &mut Cursor, shape: &str, report: &mut Report) -> Result<Vec<Row>, Stop> {
    let Some(group) = cursor.braces() else {
        let message = format!("`{{` belongs here, not {}", cursor.describe());
        report.error(codes::UNEXPECTED, &cursor.origin(report), message, format!("write `{shape}`"));
        return Err(Stop);
    };
    cursor.sign(';');
    let mut inner = Cursor::inside(&group);
    let mut rows = Vec::new();
    while !inner.is_done() {
        match row(&mut inner, shape, report) {
            Ok(row) => rows.push(row),
            Err(Stop) => while !inner.is_done() && !inner.sign(',') && inner.take().is_some() {},
        }
    }
    Ok(rows)
}

fn row(cursor: &mut Cursor, shape: &str, report: &mut Report) -> Result<Row, Stop> {
    let Some(name) = cursor.any_word() else { return Err(unexpected(cursor, "a name", shape, report)) };
    let name = names::written(&name, report);
    if !cursor.sign(':') {
        return Err(unexpected(cursor, "`:`", shape, report));
    }
    let origin = cursor.origin(report);
    let Some(word) = cursor.any_word() else { return Err(unexpected(cursor, "a type", shape, report)) };
    let word = Spanned::new(word.to_string(), origin);
    if !cursor.sign(',') && !cursor.is_done() {
        return Err(unexpected(cursor, "`,`", shape, report));
    }
    Ok(Row { name, word })
}

fn unexpected(cursor: &Cursor, what: &str, shape: &str, report: &mut Report) -> Stop {
    let message = format!("{what} belongs here, not {}", cursor.describe());
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, format!("write `{shape}`"));
    Stop
}

/// The attributes of a fragment, and the names of those whose format was refused.
pub(crate) fn attributes(rows: Vec<Row>, report: &mut Report) -> (Vec<Attribute>, Vec<String>) {
    let formats = Format::ALL.map(|format| (format.keyword(), format));
    let (typed, broken) = typed(rows, "attribute", &formats, report);
    (typed.into_iter().map(|(name, format)| Attribute { name, format }).collect(), broken)
}

/// The uniforms, and the names of those whose type was refused.
pub(crate) fn uniforms(rows: Vec<Row>, report: &mut Report) -> (Vec<Uniform>, Vec<String>) {
    let kinds = UniformType::ALL.map(|kind| (kind.keyword(), kind));
    let (typed, broken) = typed(rows, "uniform", &kinds, report);
    (typed.into_iter().map(|(name, kind)| Uniform { name, kind }).collect(), broken)
}

type Typed<T> = Vec<(Spanned<String>, Spanned<T>)>;

/// Each row's name, once, with what its type means; apart, the names whose type means nothing.
fn typed<T: Copy>(rows: Vec<Row>, what: &str, words: &[(&str, T)], report: &mut Report) -> (Typed<T>, Vec<String>) {
    let mut seen: Vec<Spanned<String>> = Vec::new();
    let (mut typed, mut broken) = (Vec::new(), Vec::new());
    for row in rows {
        let name = names::declared(&row.name, what, report);
        if let Some(first) = seen.iter().find(|other| other.value == name.value) {
            let message = format!("the {what} `{}` is given twice", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.origin, message, "rename one of them");
            report.push(diagnostic.label(&first.origin, "the first is here"));
            continue;
        }
        seen.push(name.clone());
        match words.iter().find(|(word, _)| *word == row.word.value) {
            Some((_, meaning)) => typed.push((name, Spanned::new(*meaning, row.word.origin))),
            None => {
                let message = format!("no {what} has the type `{}`", row.word.value);
                let existing: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
                let hint = near::hint(&row.word.value, &existing);
                report.error(codes::UNKNOWN_FORMAT, &row.word.origin, message, hint);
                broken.push(name.value);
            }
        }
    }
    (typed, broken)
}
