//! The items of a buffer.
//!
//! Input: the tokens inside the buffer's braces. Output: [`Items`], whose closures are not type-checked.

use fragbuf_model::{SourceSpan, codes, nearest_name};
use proc_macro2::TokenTree;

use super::cursor::{Cursor, is_punct};
use super::recovery::{end_of_item, recover, starts_item};
use super::{blocks, choices, closures};
use crate::items::Items;
use crate::raw_function::Role;
use crate::report::{Report, Stop};

/// The keywords that start an item.
const KEYWORDS: [&str; 6] = ["fragment", "uniform", "keep", "where", "resolve", "fn"];

/// Parses all items.
pub(super) fn items(cursor: &mut Cursor, report: &mut Report) -> Items {
    let mut items = Items::default();
    while !cursor.is_done() {
        if cursor.take_punct(';') {
            continue;
        }
        let before = cursor.position();
        if item(&mut items, cursor, report).is_err() {
            recover(cursor, before);
        }
    }
    items
}

fn item(items: &mut Items, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
    let span = cursor.source_span(report);
    let keyword = match cursor.peek() {
        Some(TokenTree::Ident(keyword)) => keyword.to_string(),
        _ => return Err(unknown_item(cursor, None, report)),
    };
    if is_punct(cursor.peek_second(), ':') {
        let choice = choices::choice(cursor, report)?;
        items.add_choice(choice, report);
        return Ok(());
    }
    match keyword.as_str() {
        "fragment" | "uniform" if !matches!(cursor.peek_second(), Some(TokenTree::Group(_))) => {
            without_braces(&keyword, cursor, report);
        }
        "fragment" => {
            cursor.take();
            let rows = blocks::declarations(cursor, "fragment { color: rgba8, depth: f32 }", report)?;
            items.add_attributes(rows, &span, report);
        }
        "uniform" => {
            cursor.take();
            let rows = blocks::declarations(cursor, "uniform { cut: f32 }", report)?;
            items.add_uniforms(rows, &span, report);
        }
        "keep" => keep(items, cursor, span, report)?,
        "where" => {
            cursor.take();
            let role = items.next_constraint();
            let function = closures::closure(cursor, role, &mut items.function_tokens, report)?;
            items.functions.push(function);
        }
        "resolve" => {
            cursor.take();
            let function = closures::closure(cursor, Role::Resolve, &mut items.function_tokens, report)?;
            items.add_resolve(function, &span, report);
        }
        "fn" => {
            let function = closures::helper(cursor, &mut items.function_tokens, report)?;
            items.add_helper(function, report);
        }
        _ => return Err(unknown_item(cursor, Some(&keyword), report)),
    }
    Ok(())
}

/// Reports a declaration without braces, `uniform cut: f32;`, and moves behind it.
fn without_braces(keyword: &str, cursor: &mut Cursor, report: &mut Report) {
    cursor.take();
    let found = cursor.describe();
    let span = cursor.source_span(report);
    let first = cursor.take_identifier();
    let second = if cursor.take_punct(':') { None } else { cursor.take_identifier() };
    // In other languages the type is first.
    let name = second.or(first).map_or("cut".to_owned(), |name| name.to_string());
    let help = format!("write `{keyword} {{ {name}: f32 }}`, all in one block");
    report.error(codes::UNEXPECTED_TOKEN, &span, format!("expected `{{`, found {found}"), help);
    while !cursor.is_done() && !starts_item(cursor) && !cursor.take_punct(';') {
        cursor.take();
    }
}

fn keep(items: &mut Items, cursor: &mut Cursor, span: SourceSpan, report: &mut Report) -> Result<(), Stop> {
    cursor.take();
    let count = choices::count(cursor, report)?;
    let criterion = if cursor.take_keyword("least") {
        Some(closures::closure(cursor, Role::Criterion, &mut items.function_tokens, report)?)
    } else {
        if cursor.at_keyword("greatest") || cursor.at_keyword("most") {
            return Err(cursor.expected("`least`", "negate the value instead: `keep 8 least |f| -f.depth;`", report));
        }
        end_of_item(cursor, "keep 8;` or, to choose by a value, `keep 8 least |f| …;", report)?;
        None
    };
    items.add_keep(count, criterion, span, report);
    Ok(())
}

fn unknown_item(cursor: &Cursor, keyword: Option<&str>, report: &mut Report) -> Stop {
    if cursor.at_punct('#') {
        closures::reject_attribute(&cursor.source_span(report), report);
        return Stop;
    }
    let message = match keyword {
        Some("buffer") => "buffers cannot be nested".to_string(),
        _ => format!("expected an item, found {}", cursor.describe()),
    };
    let help = match keyword.and_then(|keyword| nearest_name(keyword, &KEYWORDS)) {
        _ if matches!(keyword, Some("pub" | "unsafe" | "const" | "async" | "extern")) => {
            "helper functions start with `fn`: remove this keyword".to_string()
        }
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None if is_punct(cursor.peek_second(), '=') || matches!(cursor.peek_second(), Some(TokenTree::Ident(_))) => {
            format!("a choice has a colon: `{}: …;`", keyword.unwrap_or("axis"))
        }
        None => "items start with `fragment`, `uniform`, `keep`, `where`, `resolve`, `fn`, or `axis:`".to_string(),
    };
    report.error(codes::UNEXPECTED_TOKEN, &cursor.source_span(report), message, help);
    Stop
}
