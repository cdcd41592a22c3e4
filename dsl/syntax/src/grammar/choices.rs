//! Choices `axis: value { option: … } else value;`, and the number that `keep` begins with.
//!
//! In: tokens at the axis, or behind `keep`. Out: what was written; whether such an axis or value exists is the
//! registry's to say.

use std::path::Path;

use fragbuf_model::{Alternative, Choice, Diagnostic, KeepCount, OptionValue, Spanned, codes};
use proc_macro2::{Delimiter, Group, TokenTree};

use super::cursor::Cursor;
use super::items::end_of_item;
use super::{Stop, names};
use crate::report::Report;

const SHAPE: &str = "sync: interlock else spin_lock { limit: 4096 };";

/// `axis: value else value;`
pub(crate) fn choice(cursor: &mut Cursor, report: &mut Report) -> Result<Choice, Stop> {
    let axis = word(cursor, "an axis", report)?;
    refuse_items(&axis, report)?;
    cursor.sign(':');
    let mut alternatives: Vec<Alternative> = Vec::new();
    loop {
        alternatives.push(alternative(cursor, report)?);
        if !cursor.word("else") {
            break;
        }
    }
    let choice = distinct(Choice { axis, alternatives }, report);
    end_of_item(cursor, SHAPE, report)?;
    Ok(choice)
}

/// A choice that another door made, its words not yet looked at.
pub(crate) fn given(choice: &Choice, report: &mut Report) -> Result<Choice, Stop> {
    let axis = names::word(&choice.axis, report);
    refuse_items(&axis, report)?;
    let mut alternatives = Vec::with_capacity(choice.alternatives.len());
    for alternative in &choice.alternatives {
        let mut options = Options::with_capacity(alternative.options.len());
        for (name, value) in &alternative.options {
            let value = match &value.value {
                OptionValue::Word(text) => {
                    let word = names::word(&Spanned::new(text.clone(), value.origin.clone()), report);
                    Spanned::new(OptionValue::Word(word.value), word.origin)
                }
                OptionValue::Number(_) => value.clone(),
            };
            options.push((names::word(name, report), value));
        }
        alternatives.push(Alternative { value: names::word(&alternative.value, report), options });
    }
    Ok(distinct(Choice { axis, alternatives }, report))
}

/// The choice without what it gives a second time.
fn distinct(choice: Choice, report: &mut Report) -> Choice {
    let mut alternatives: Vec<Alternative> = Vec::with_capacity(choice.alternatives.len());
    for next in choice.alternatives {
        let next = Alternative { value: next.value, options: distinct_options(next.options, report) };
        match alternatives.iter().find(|other| other.value.value == next.value.value) {
            Some(first) => {
                let message = format!("`{}` is given twice", next.value.value);
                let hint = "only the first of two equal alternatives could ever be taken: leave one out";
                let diagnostic = Diagnostic::new(codes::DUPLICATE, &next.value.origin, message, hint);
                report.push(diagnostic.label(&first.value.origin, "the first is here"));
            }
            None => alternatives.push(next),
        }
    }
    Choice { axis: choice.axis, alternatives }
}

fn distinct_options(given: Options, report: &mut Report) -> Options {
    let mut options = Options::with_capacity(given.len());
    for (name, value) in given {
        match options.iter().find(|other| other.0.value == name.value) {
            Some((first, _)) => {
                let message = format!("the option `{}` is given twice", name.value);
                let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.origin, message, "leave one of them out");
                report.push(diagnostic.label(&first.origin, "the first is here"));
            }
            None => options.push((name, value)),
        }
    }
    options
}

/// Items that are no axes, though they may look so.
fn refuse_items(axis: &Spanned<String>, report: &mut Report) -> Result<(), Stop> {
    let Some(hint) = not_an_axis(&axis.value) else { return Ok(()) };
    let message = format!("`{}` is not an axis", axis.value);
    report.error(codes::UNEXPECTED, &axis.origin, message, hint);
    Err(Stop)
}

fn not_an_axis(word: &str) -> Option<&'static str> {
    match word {
        "keep" => Some("write `keep 8;`, without a colon"),
        "where" => Some("write `where |f| f.depth > 0.5;`, without a colon"),
        "fragment" | "uniform" => Some("write `fragment { depth: f32 }`, without a colon"),
        "fn" | "buffer" => Some("choose from the axes, such as `storage`, `sync`, `sort`"),
        _ => None,
    }
}

fn alternative(cursor: &mut Cursor, report: &mut Report) -> Result<Alternative, Stop> {
    let value = match own_file(cursor, report)? {
        Some(file) => file,
        None => word(cursor, "a value", report)?,
    };
    let options = match cursor.braces() {
        Some(group) => options(&group, report),
        None => Vec::new(),
    };
    Ok(Alternative { value, options })
}

/// `wgsl("path")`, if that comes next: a file of the user's own in place of a word of the registry.
fn own_file(cursor: &mut Cursor, report: &mut Report) -> Result<Option<Spanned<String>>, Stop> {
    let Some(TokenTree::Group(group)) = cursor.peek_second().filter(|_| cursor.at_word("wgsl")) else {
        return Ok(None);
    };
    if group.delimiter() != Delimiter::Parenthesis {
        return Ok(None);
    }
    let mut inside = Cursor::inside(group);
    cursor.take();
    cursor.take();
    let origin = inside.origin(report);
    let path = inside.take().and_then(|token| syn::parse2::<syn::LitStr>(token.into()).ok()).map(|path| path.value());
    match path.filter(|path| is_relative(path) && inside.is_done()) {
        Some(path) => Ok(Some(Spanned::new(Alternative::value_of_file(&path), origin))),
        None => {
            let message = "a path in quotes belongs between the parentheses, relative to this description";
            report.error(codes::UNEXPECTED, &origin, message, "write `storage: wgsl(\"my_storage.wgsl\");`");
            Err(Stop)
        }
    }
}

/// Paths appear in generated text, which must not depend on where a description lies.
fn is_relative(path: &str) -> bool {
    let is_plain = !path.is_empty() && !path.contains(|letter: char| letter.is_control() || letter == '\\');
    is_plain && !Path::new(path).is_absolute() && !path.starts_with('/')
}

fn word(cursor: &mut Cursor, what: &str, report: &mut Report) -> Result<Spanned<String>, Stop> {
    match cursor.peek() {
        Some(TokenTree::Ident(word)) => {
            let word = names::written(word, report);
            cursor.take();
            Ok(names::word(&word, report))
        }
        _ => {
            let message = format!("{what} belongs here, not {}", cursor.describe());
            report.error(codes::UNEXPECTED, &cursor.origin(report), message, format!("write `{SHAPE}`"));
            Err(Stop)
        }
    }
}

type Options = Vec<(Spanned<String>, Spanned<OptionValue>)>;

fn options(group: &Group, report: &mut Report) -> Options {
    let mut cursor = Cursor::inside(group);
    let mut options = Options::new();
    while !cursor.is_done() {
        match option(&mut cursor, report) {
            Ok(option) => options.push(option),
            Err(Stop) => while !cursor.is_done() && !cursor.sign(',') && cursor.take().is_some() {},
        }
    }
    options
}

fn option(cursor: &mut Cursor, report: &mut Report) -> Result<(Spanned<String>, Spanned<OptionValue>), Stop> {
    let name = word(cursor, "an option", report)?;
    if !cursor.sign(':') {
        return Err(option_shape(cursor, "`:`", report));
    }
    let origin = cursor.origin(report);
    let value = match cursor.peek() {
        Some(TokenTree::Literal(_)) => OptionValue::Number(number(cursor, report)?),
        Some(TokenTree::Ident(word)) => {
            let word = names::written(word, report);
            cursor.take();
            OptionValue::Word(names::word(&word, report).value)
        }
        _ => return Err(option_shape(cursor, "a number or a word", report)),
    };
    if !cursor.sign(',') && !cursor.is_done() {
        return Err(option_shape(cursor, "`,`", report));
    }
    Ok((name, Spanned::new(value, origin)))
}

fn option_shape(cursor: &Cursor, what: &str, report: &mut Report) -> Stop {
    let message = format!("{what} belongs here, not {}", cursor.describe());
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, "write `{ limit: 4096, order: front }`");
    Stop
}

/// What `keep` begins with: a number, or `all`.
pub(crate) fn count(cursor: &mut Cursor, report: &mut Report) -> Result<Spanned<KeepCount>, Stop> {
    let origin = cursor.origin(report);
    if cursor.word("all") {
        return Ok(Spanned::new(KeepCount::All, origin));
    }
    if matches!(cursor.peek(), Some(TokenTree::Literal(_))) {
        return Ok(Spanned::new(KeepCount::AtMost(number(cursor, report)?), origin));
    }
    let message = format!("how many to keep belongs here, not {}", cursor.describe());
    report.error(codes::UNEXPECTED, &origin, message, "write `keep 8;` or `keep all;`");
    Err(Stop)
}

/// A whole number of 32 bits; the next token is a literal.
fn number(cursor: &mut Cursor, report: &mut Report) -> Result<u32, Stop> {
    let origin = cursor.origin(report);
    let found = cursor.describe();
    let literal = match cursor.take() {
        Some(token) => syn::parse2::<syn::LitInt>(token.into()),
        None => return Err(Stop),
    };
    match literal {
        Ok(literal) if matches!(literal.suffix(), "" | "u32" | "usize") => match literal.base10_parse::<u32>() {
            Ok(value) => Ok(value),
            Err(_) => {
                let message = format!("{found} does not fit 32 bits");
                report.error(codes::OUT_OF_RANGE, &origin, message, format!("the greatest number is {}", u32::MAX));
                Err(Stop)
            }
        },
        _ => {
            let message = format!("a whole number belongs here, not {found}");
            report.error(codes::UNEXPECTED, &origin, message, "write digits only, such as `8`");
            Err(Stop)
        }
    }
}
