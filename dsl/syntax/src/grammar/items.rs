//! The items of a buffer.
//!
//! Input: the tokens inside the buffer's braces. Output: [`Items`], whose closures are not type-checked.

use fragbuf_model::{Incomplete, SourceSpan, codes, nearest_name};
use proc_macro2::{Delimiter, TokenTree};

use super::blocks::{self, DeclarationBlock};
use super::cursor::{Cursor, is_punct};
use super::recovery::{end_of_item, recover, reject_alternatives, source_of_rest, starts_item};
use super::{choices, closures, constants};
use crate::items::Items;
use crate::names;
use crate::raw_function::Role;
use crate::report::{Report, Stop};

/// The keywords that start an item.
pub(crate) const KEYWORDS: [&str; 9] =
    ["fragment", "uniform", "texture", "keep", "where", "image", "between", "resolve", "fn"];

/// Words that users write for items, and how the language has them.
const SYNONYMS: &[(&[&str], &str)] = &[
    (
        &["criterion", "least", "order", "priority", "sort_by"],
        "the criterion follows `keep`: `keep 8 least |f| f.depth;`",
    ),
    (&["constraint", "filter", "if", "require", "discard"], "write `where |f| f.depth > 0.5;`"),
    (&["effect", "shade", "color", "output", "composite", "blend"], "the effect is `resolve |fragments| { … }`"),
    (&["attributes", "attribute", "in", "struct"], "write `fragment { color: rgba8, depth: f32 }`"),
    (&["parameters", "params", "constants", "cbuffer"], "write `uniform { cut: f32 }`"),
    (&["textures", "sampler", "sampler2D", "tex"], "write `texture { lut: 2d }`"),
    (&["pass", "step", "buffer_pass"], "an image that the effect reads is `image name |fragments| { … }`"),
    (&["pair", "gap"], "an effect of two neighbouring fragments is `between |front, back, gap| { … }`"),
    (&["function", "def", "func", "void"], "write `fn name(x: f32) -> f32 { … }`"),
];

/// Whether a function of another language is next: `float name(…) { … }`.
fn is_c_function(cursor: &Cursor) -> bool {
    let is_parenthesis =
        |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis);
    matches!(cursor.peek_second(), Some(TokenTree::Ident(_))) && cursor.peek_third().is_some_and(is_parenthesis)
}

/// Parses all items.
pub(super) fn items(cursor: &mut Cursor, report: &mut Report) -> Items {
    let mut items = Items::default();
    while !cursor.is_done() {
        if cursor.take_punct(';') {
            continue;
        }
        let (before, part) = (cursor.position(), part_of_item(cursor));
        if item(&mut items, cursor, report).is_err() {
            items.incomplete = items.incomplete.or(part);
            recover(cursor, before);
        }
    }
    items
}

/// Returns the part of the description that the next item gives. An unknown item with braces may be a block, and others a choice.
fn part_of_item(cursor: &Cursor) -> Incomplete {
    let none = Incomplete::default();
    let Some(TokenTree::Ident(keyword)) = cursor.peek() else { return Incomplete::ALL };
    match nearest_name(&keyword.to_string(), &KEYWORDS) {
        Some("resolve" | "between") => Incomplete { resolve: true, ..none },
        _ if is_punct(cursor.peek_second(), ':') => Incomplete { choices: true, ..none },
        Some("fragment") => Incomplete { attributes: true, ..none },
        Some("uniform" | "texture" | "image") => Incomplete { uniforms: true, ..none },
        Some("keep") => Incomplete { keep: true, ..none },
        Some("where") => none,
        Some("fn") => Incomplete { helpers: true, ..none },
        _ if is_c_function(cursor) => Incomplete { helpers: true, ..none },
        _ if matches!(cursor.peek_second(), Some(TokenTree::Group(_))) => {
            Incomplete { attributes: true, uniforms: true, ..none }
        }
        _ => Incomplete { keep: true, choices: true, ..none },
    }
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
        "const" | "let" | "static" if constants::starts(cursor) => {
            let name = constants::reject(cursor, report);
            items.constants.extend(name);
        }
        "fragment" | "uniform" | "texture" if !matches!(cursor.peek_second(), Some(TokenTree::Group(_))) => {
            items.incomplete = items.incomplete.or(part_of_item(cursor));
            let block = match keyword.as_str() {
                "fragment" => DeclarationBlock::Fragment,
                "uniform" => DeclarationBlock::Uniform,
                _ => DeclarationBlock::Texture,
            };
            without_braces(&keyword, block, cursor, report);
        }
        "fragment" => {
            cursor.take();
            let errors = report.count();
            let rows = blocks::declarations(cursor, DeclarationBlock::Fragment, report)?;
            items.incomplete.attributes |= report.count() > errors;
            items.add_attributes(rows, &span, report);
        }
        "uniform" => {
            cursor.take();
            let errors = report.count();
            let rows = blocks::declarations(cursor, DeclarationBlock::Uniform, report)?;
            items.incomplete.uniforms |= report.count() > errors;
            items.add_uniforms(rows, &span, report);
        }
        "texture" => {
            cursor.take();
            let errors = report.count();
            let rows = blocks::declarations(cursor, DeclarationBlock::Texture, report)?;
            items.incomplete.uniforms |= report.count() > errors;
            items.add_textures(rows, &span, report);
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
            items.effect.get_or_insert(cursor.source_span(report));
            let function = closures::closure(cursor, Role::Resolve, &mut items.function_tokens, report)?;
            items.add_resolve(function, &span, report);
        }
        "between" => {
            cursor.take();
            items.effect.get_or_insert(cursor.source_span(report));
            let function = closures::closure(cursor, Role::Between, &mut items.function_tokens, report)?;
            items.add_resolve(function, &span, report);
        }
        "image" => image(items, cursor, report)?,
        "fn" => {
            let function = closures::helper(cursor, &mut items.function_tokens, report)?;
            items.add_helper(function, report);
        }
        _ => return Err(unknown_item(cursor, Some(&keyword), report)),
    }
    Ok(())
}

/// Reports a declaration without braces, `uniform cut: f32;`, and moves behind it.
fn without_braces(keyword: &str, block: DeclarationBlock, cursor: &mut Cursor, report: &mut Report) {
    cursor.take();
    let found = cursor.describe();
    let span = cursor.source_span(report);
    let first = cursor.take_identifier();
    cursor.take_punct(':');
    let second = cursor.take_word();
    let declaration = match (first, second) {
        (Some(first), Some(second)) => block.declaration(&first.to_string(), &second),
        (Some(name), None) => format!("{name}: {}", block.usual_type()),
        _ => format!("cut: {}", block.usual_type()),
    };
    let depth = match block {
        DeclarationBlock::Fragment if !declaration.starts_with("depth:") => ", depth: f32",
        _ => "",
    };
    let help = format!("write `{keyword} {{ {declaration}{depth} }}`, all in one block");
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
        let is_least = |word: &TokenTree| nearest_name(&word.to_string(), &["least"]).is_some();
        if matches!(cursor.peek(), Some(word @ TokenTree::Ident(_)) if is_least(word)) {
            return Err(cursor.expected("`least` or `;`", "did you mean `least`?", report));
        }
        if cursor.at_punct('|') {
            return Err(cursor.expected(
                "`least`",
                "write `least` before the criterion: `keep 8 least |f| …;`",
                report,
            ));
        }
        if cursor.at_keyword("else") {
            let rest = source_of_rest(cursor);
            let help = format!("k is the same on all targets: remove `{rest}`; `--set k=8` changes k for one command");
            reject_alternatives(cursor, "`keep`", &help, report);
        } else {
            end_of_item(cursor, report)?;
        }
        None
    };
    items.add_keep(count, criterion, span, report);
    Ok(())
}

/// Parses `image name |fragments, u| …`.
fn image(items: &mut Items, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
    cursor.take();
    let Some(name) = cursor.take_identifier() else {
        let help = "write `image name |fragments| { … }`; closures after it read it as `u.name.at(1, 0)`";
        return Err(cursor.expected("a name", help, report));
    };
    let name = names::declared(&names::written(&name, report), "image", report);
    let role = Role::Image(name.value.clone());
    let function = closures::closure(cursor, role, &mut items.function_tokens, report)?;
    items.add_image(name, function);
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
    let synonym = keyword.and_then(|keyword| SYNONYMS.iter().find(|(words, _)| words.contains(&keyword)));
    let help = match (keyword.and_then(|keyword| nearest_name(keyword, &KEYWORDS)), synonym) {
        _ if cursor.at_punct(',') => "remove it: items are not separated by commas".to_string(),
        _ if is_c_function(cursor) => "write a function as in Rust: `fn name(x: f32) -> f32 { … }`".to_string(),
        _ if matches!(keyword, Some("pub" | "unsafe" | "const" | "async" | "extern")) => {
            "helper functions start with `fn`: remove this keyword".to_string()
        }
        (Some(nearest), _) => format!("did you mean `{nearest}`?"),
        (None, Some((_, help))) => (*help).to_string(),
        _ if is_punct(cursor.peek_second(), '=') || matches!(cursor.peek_second(), Some(TokenTree::Ident(_))) => {
            format!("a choice has a colon: `{}: …;`", keyword.unwrap_or("axis"))
        }
        _ => "items start with `fragment`, `uniform`, `texture`, `keep`, `where`, `image`, `between`, `resolve`, `fn`, or `axis:`".to_string(),
    };
    report.error(codes::UNEXPECTED_TOKEN, &cursor.source_span(report), message, help);
    Stop
}
