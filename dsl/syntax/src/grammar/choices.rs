//! Choices `axis: value { option: … } else value;`, and the number that `keep` begins with.
//!
//! Input: tokens from the axis, or after `keep`. Output: the choice as written. `fragbuf_model` checks that the axis and
//! the values exist.

use std::path::Path;

use fragbuf_model::{Alternative, Choice, Diagnostic, KeepCount, OptionValue, SET, Spanned, codes};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use super::cursor::{Cursor, is_punct};
use super::recovery::{end_of_item_or, starts_item};
use crate::names;
use crate::report::{FIRST, Report, Stop};

/// The form of a value.
const VALUE_HELP: &str = "a value is a name, and its options are in braces: `sync: spin_lock { limit: 4096 };`";

/// The form of a value that the command line gives.
const OUTSIDE_HELP: &str = "a value is a name, and its options are in braces: `sync=spin_lock { limit: 4096 }`";

/// The form of options.
const OPTION_HELP: &str = "write each option as `name: value`, and separate them by commas";

/// Parses `axis: value else value;`.
pub(super) fn choice(cursor: &mut Cursor, report: &mut Report) -> Result<Choice, Stop> {
    let axis = identifier(cursor, "an axis", VALUE_HELP, report)?;
    reject_items(&axis, report)?;
    cursor.take_punct(':');
    let choice = alternatives(axis, cursor, report)?;
    end_of_item_or(cursor, &help_after(&choice, cursor), report)?;
    Ok(choice)
}

/// Parses `value { option: … } else value`.
fn alternatives(axis: Spanned<String>, cursor: &mut Cursor, report: &mut Report) -> Result<Choice, Stop> {
    let mut alternatives: Vec<Alternative> = Vec::new();
    loop {
        alternatives.push(alternative(&axis, cursor, report)?);
        if !cursor.take_keyword("else") {
            break;
        }
    }
    Ok(without_duplicates(Choice { axis, alternatives }, report))
}

/// Parses the alternatives of a choice from all of these tokens.
pub(crate) fn all_alternatives(
    axis: &Spanned<String>,
    tokens: TokenStream,
    report: &mut Report,
) -> Result<Choice, Stop> {
    let mut cursor = Cursor::new(tokens);
    let choice = alternatives(axis.clone(), &mut cursor, report)?;
    if cursor.is_done() {
        return Ok(choice);
    }
    Err(cursor.expected("the end of the value", OUTSIDE_HELP, report))
}

/// Returns the help for what follows a choice in place of its `;`.
fn help_after(choice: &Choice, cursor: &Cursor) -> String {
    let last = choice.alternatives.last().map_or("", |alternative| alternative.value.value.as_str());
    match (cursor.peek(), cursor.peek_second()) {
        (Some(TokenTree::Group(group)), _) if group.delimiter() == Delimiter::Parenthesis => {
            let is_text =
                |token: &TokenTree| matches!(token, TokenTree::Literal(text) if text.to_string().starts_with('"'));
            let is_file = group.stream().into_iter().all(|token| is_text(&token));
            match is_file {
                true => format!("a user file is WGSL: `{}: wgsl(\"file.wgsl\");`", choice.axis.value),
                false => "options are in braces: `{ … }`".to_owned(),
            }
        }
        (Some(TokenTree::Punct(_)), Some(TokenTree::Ident(next))) if is_punct(cursor.peek_third(), ':') => {
            format!("end the item with `;`: `{}: {last}; {next}: …`", choice.axis.value)
        }
        (Some(TokenTree::Punct(punct)), Some(TokenTree::Ident(next))) => match punct.as_char() {
            '-' => format!("names have `_` in place of `-`: `{last}_{next}`"),
            ',' | '|' | '/' => format!("alternatives are separated by `else`: `{last} else {next}`"),
            _ => "end the item with `;`".to_owned(),
        },
        // `a or b`, and `a b` in place of `a else b`.
        (Some(TokenTree::Ident(word)), Some(TokenTree::Ident(next))) if is_separator(&word.to_string()) => {
            format!("alternatives are separated by `else`: `{last} else {next}`")
        }
        (Some(TokenTree::Ident(next)), _) if !starts_item(cursor) => {
            format!("end the item with `;`, or separate alternatives by `else`: `{last} else {next}`")
        }
        _ => "end the item with `;`".to_owned(),
    }
}

/// Whether a word separates alternatives in other languages.
fn is_separator(word: &str) -> bool {
    matches!(word, "or" | "and" | "then" | "otherwise")
}

/// Returns a choice that a builder made, after the same checks of its names.
pub(crate) fn from_builder(choice: &Choice, report: &mut Report) -> Result<Choice, Stop> {
    let axis = names::identifier(&choice.axis, report);
    reject_items(&axis, report)?;
    let mut alternatives = Vec::with_capacity(choice.alternatives.len());
    for alternative in &choice.alternatives {
        let mut options = Options::with_capacity(alternative.options.len());
        for (name, value) in &alternative.options {
            let value = match &value.value {
                OptionValue::Name(name) => {
                    let name = names::identifier(&Spanned::new(name.clone(), value.span.clone()), report);
                    Spanned::new(OptionValue::Name(name.value), name.span)
                }
                OptionValue::Number(_) => value.clone(),
            };
            options.push((names::identifier(name, report), value));
        }
        reject_several(&alternative.value, report)?;
        alternatives.push(Alternative { value: names::identifier(&alternative.value, report), options });
    }
    Ok(without_duplicates(Choice { axis, alternatives }, report))
}

/// Rejects several values in one string, which only a builder can pass: `choose("sync", "interlock, spin_lock")`.
fn reject_several(value: &Spanned<String>, report: &mut Report) -> Result<(), Stop> {
    let text = value.value.replace(" or ", ",").replace(" else ", ",");
    let values: Vec<&str> = text.split([',', '|', '/']).map(str::trim).collect();
    let [first, second, ..] = values.as_slice() else { return Ok(()) };
    // A user file is one value, and its path may have a `/`.
    if value.value.starts_with("wgsl:") || !values.iter().all(|value| syn::parse_str::<syn::Ident>(value).is_ok()) {
        return Ok(());
    }
    let message = format!("expected one value, found `{}`", value.value);
    let help = format!(
        "alternatives are separated by `else`: `{}`, or `value(\"{first}\").or_else(\"{second}\")` in a program",
        values.join(" else ")
    );
    report.error(codes::UNEXPECTED_TOKEN, &value.span, message, help);
    Err(Stop)
}

/// Returns the choice without duplicate alternatives and options, which are reported.
fn without_duplicates(choice: Choice, report: &mut Report) -> Choice {
    let mut alternatives: Vec<Alternative> = Vec::with_capacity(choice.alternatives.len());
    for next in choice.alternatives {
        let next = Alternative { value: next.value, options: unique_options(next.options, report) };
        match alternatives.iter().find(|other| other.value.value == next.value.value) {
            Some(first) => {
                let message = format!("duplicate alternative `{}`", next.value.value);
                let help = "remove it: the first of two equal alternatives is always taken";
                let diagnostic = Diagnostic::new(codes::DUPLICATE, &next.value.span, message, help);
                report.push(diagnostic.label(&first.value.span, FIRST));
            }
            None => alternatives.push(next),
        }
    }
    Choice { axis: choice.axis, alternatives }
}

fn unique_options(given: Options, report: &mut Report) -> Options {
    let mut options = Options::with_capacity(given.len());
    for (name, value) in given {
        match options.iter().find(|other| other.0.value == name.value) {
            Some((first, _)) => {
                let message = format!("duplicate option `{}`", name.value);
                let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.span, message, "remove one of them");
                report.push(diagnostic.label(&first.span, FIRST));
            }
            None => options.push((name, value)),
        }
    }
    options
}

/// Rejects the keyword of another item before a `:`.
fn reject_items(axis: &Spanned<String>, report: &mut Report) -> Result<(), Stop> {
    let Some(help) = not_an_axis(&axis.value) else { return Ok(()) };
    let message = format!("expected an axis, found `{}`", axis.value);
    report.error(codes::UNEXPECTED_TOKEN, &axis.span, message, help);
    Err(Stop)
}

fn not_an_axis(name: &str) -> Option<&'static str> {
    match name {
        "keep" => Some("write `keep 8;`, without a colon"),
        "where" => Some("write `where |f| f.depth > 0.5;`, without a colon"),
        "fragment" | "uniform" => Some("write `fragment { depth: f32 }`, without a colon"),
        "fn" | "buffer" => Some("write an axis, such as `storage`, `sync` or `sort`"),
        _ => None,
    }
}

/// Returns a choice as it is written in a description, or as the option of the command line.
fn written(axis: &Spanned<String>, value: &str) -> String {
    match &*axis.span.file == SET {
        true => format!("{SET} {}={value}", axis.value),
        false => format!("{}: {value};", axis.value),
    }
}

/// Returns a user file as the value of a choice.
fn written_file(axis: &Spanned<String>, path: &str) -> String {
    match &*axis.span.file == SET {
        true => written(axis, path),
        false => written(axis, &format!("wgsl(\"{path}\")")),
    }
}

/// Returns the help for a token that is no value.
fn help_for_value(axis: &Spanned<String>, cursor: &Cursor) -> String {
    let form = || match &*axis.span.file == SET {
        true => OUTSIDE_HELP.to_owned(),
        false => VALUE_HELP.to_owned(),
    };
    let Some(TokenTree::Literal(literal)) = cursor.peek() else { return form() };
    let text = literal.to_string();
    match text.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
        Some(path) if path.ends_with(".wgsl") => format!("write `{}`", written_file(axis, path)),
        Some(name) => format!("write the name without quotes: `{}`", written(axis, name)),
        None if axis.value == "k" => format!("write `keep {text};`"),
        None => form(),
    }
}

fn alternative(axis: &Spanned<String>, cursor: &mut Cursor, report: &mut Report) -> Result<Alternative, Stop> {
    let value = match user_file(axis, cursor, report)? {
        Some(file) => file,
        None => {
            let help = help_for_value(axis, cursor);
            identifier(cursor, "a value", &help, report)?
        }
    };
    let options = match cursor.take_braces() {
        Some(group) => options(&group, report),
        None => Vec::new(),
    };
    Ok(Alternative { value, options })
}

/// Parses `wgsl("path")` if it is next: a user file in place of a name of the registry.
fn user_file(
    axis: &Spanned<String>,
    cursor: &mut Cursor,
    report: &mut Report,
) -> Result<Option<Spanned<String>>, Stop> {
    let Some(TokenTree::Group(group)) = cursor.peek_second().filter(|_| cursor.at_keyword("wgsl")) else {
        return Ok(None);
    };
    if group.delimiter() != Delimiter::Parenthesis {
        return Ok(None);
    }
    let mut inside = Cursor::inside(group);
    cursor.take();
    cursor.take();
    let span = inside.source_span(report);
    let found = inside.describe();
    let path = inside.take().and_then(|token| syn::parse2::<syn::LitStr>(token.into()).ok()).map(|path| path.value());
    let (message, help) = match path.filter(|_| inside.is_done()) {
        Some(path) if is_relative(&path) => return Ok(Some(Spanned::new(Alternative::value_of_file(&path), span))),
        Some(path) if is_absolute(&path) => {
            let name = path.rsplit(['/', '\\']).next().unwrap_or(&path);
            let message = format!("expected a path relative to {}, found {found}", folder(axis));
            (message, format!("with the file in that folder, write `{}`", written_file(axis, name)))
        }
        Some(path) if path.contains('\\') => {
            let message = format!("expected a path with `/` between folders, found {found}");
            (message, format!("write `{}`", written_file(axis, &path.replace('\\', "/"))))
        }
        _ => {
            let message = format!("expected a quoted path relative to {}, found {found}", folder(axis));
            (message, format!("write `{}`", written_file(axis, "file.wgsl")))
        }
    };
    report.error(codes::UNEXPECTED_TOKEN, &span, message, help);
    Err(Stop)
}

/// Returns the folder to which paths are relative.
fn folder(axis: &Spanned<String>) -> &'static str {
    if &*axis.span.file == SET { "the current folder" } else { "the description" }
}

/// Returns whether a path is absolute, on any system.
fn is_absolute(path: &str) -> bool {
    Path::new(path).is_absolute() || path.starts_with(['/', '\\']) || path.get(1..3) == Some(":\\")
}

/// Returns whether a path is relative. Paths appear in generated source, which must not depend on the description's folder.
fn is_relative(path: &str) -> bool {
    let is_plain = !path.is_empty() && !path.contains(|letter: char| letter.is_control() || letter == '\\');
    is_plain && !Path::new(path).is_absolute() && !path.starts_with('/')
}

fn identifier(cursor: &mut Cursor, what: &str, help: &str, report: &mut Report) -> Result<Spanned<String>, Stop> {
    match cursor.peek() {
        Some(TokenTree::Ident(name)) => {
            let name = names::written(name, report);
            cursor.take();
            Ok(names::identifier(&name, report))
        }
        _ => Err(cursor.expected(what, help, report)),
    }
}

type Options = Vec<(Spanned<String>, Spanned<OptionValue>)>;

fn options(group: &Group, report: &mut Report) -> Options {
    let mut cursor = Cursor::inside(group);
    let mut options = Options::new();
    while !cursor.is_done() {
        match option(&mut cursor, report) {
            Ok(option) => options.push(option),
            Err(Stop) => cursor.skip_past_comma(),
        }
    }
    options
}

fn option(cursor: &mut Cursor, report: &mut Report) -> Result<(Spanned<String>, Spanned<OptionValue>), Stop> {
    let name = identifier(cursor, "an option", OPTION_HELP, report)?;
    if !cursor.take_punct(':') {
        let value = if cursor.at_punct('=') { cursor.peek_second() } else { cursor.peek() };
        let help = match value {
            Some(value @ (TokenTree::Literal(_) | TokenTree::Ident(_))) => format!("write `{}: {value}`", name.value),
            _ => OPTION_HELP.to_owned(),
        };
        return Err(cursor.expected("`:`", help, report));
    }
    let span = cursor.source_span(report);
    let value = match cursor.peek() {
        Some(TokenTree::Literal(_)) => OptionValue::Number(number(cursor, report)?),
        Some(TokenTree::Ident(name)) => {
            let name = names::written(name, report);
            cursor.take();
            OptionValue::Name(names::identifier(&name, report).value)
        }
        _ if cursor.at_punct('-') => {
            return Err(cursor.expected("a number or a name", "numbers of options are 0 or more", report));
        }
        _ => return Err(cursor.expected("a number or a name", OPTION_HELP, report)),
    };
    if !cursor.take_punct(',') && !cursor.is_done() {
        return Err(cursor.expected("`,`", OPTION_HELP, report));
    }
    Ok((name, Spanned::new(value, span)))
}

/// Parses the count of `keep`: a number, or `all`.
pub(super) fn count(cursor: &mut Cursor, report: &mut Report) -> Result<Spanned<KeepCount>, Stop> {
    let span = cursor.source_span(report);
    if cursor.take_keyword("all") {
        return Ok(Spanned::new(KeepCount::All, span));
    }
    if matches!(cursor.peek(), Some(TokenTree::Literal(_))) {
        return Ok(Spanned::new(KeepCount::AtMost(number(cursor, report)?), span));
    }
    Err(cursor.expected("a number or `all`", "write `keep 8;` or `keep all;`", report))
}

/// Parses an integer of 32 bits; the next token is a literal.
fn number(cursor: &mut Cursor, report: &mut Report) -> Result<u32, Stop> {
    let span = cursor.source_span(report);
    let found = cursor.describe();
    let literal = match cursor.take() {
        Some(token) => syn::parse2::<syn::LitInt>(token.into()),
        None => return Err(Stop),
    };
    match literal {
        Ok(literal) if matches!(literal.suffix(), "" | "u32" | "usize") => match literal.base10_parse::<u32>() {
            Ok(value) => Ok(value),
            Err(_) => {
                let message = format!("integer {found} out of range for 32 bits");
                report.error(codes::OUT_OF_RANGE, &span, message, format!("the maximum is {}", u32::MAX));
                Err(Stop)
            }
        },
        _ => {
            let message = format!("expected an integer, found {found}");
            report.error(codes::UNEXPECTED_TOKEN, &span, message, "write digits only, such as `8`");
            Err(Stop)
        }
    }
}
