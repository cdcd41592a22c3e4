//! The grammar of a description: one buffer, and the items in its braces.
//!
//! Input: tokens without documentation comments. Output: a [`RawDescription`], whose functions are not type-checked.
//! After an error, parsing continues after the next `;` or `{ … }` of the same level, so that all errors of a description
//! are reported together.

mod blocks;
mod c_loop;
mod c_syntax;
mod choices;
mod closures;
mod constants;
mod cursor;
mod items;
mod recovery;
mod syntax_error;

pub(crate) use choices::all_alternatives as alternatives;
pub(crate) use choices::from_builder as choice_from_builder;
pub(crate) use closures::{whole_closure, whole_helper};
pub(crate) use items::KEYWORDS;

use fragbuf_model::{Diagnostic, SourceSpan, Spanned, codes, nearest_name};
use proc_macro2::{Group, TokenStream, TokenTree};

use crate::items::RawDescription;
use crate::names;
use crate::report::{FIRST, Report, Stop};
use cursor::Cursor;

/// Parses a whole description: `buffer Name from technique { … }`.
pub(crate) fn description(tokens: TokenStream, report: &mut Report) -> Option<RawDescription> {
    let mut cursor = Cursor::new(tokens);
    find_buffer(&mut cursor, report)?;
    let start = cursor.source_span(report);
    cursor.take_keyword("buffer");
    let name = name_of_buffer(&mut cursor, report);
    let preset = preset(&mut cursor, report);
    let errors = report.count();
    let body = body(&mut cursor, report)?;
    let is_header_invalid = preset.is_err() || report.count() > errors;
    let mut items = items::items(&mut Cursor::inside(&body), report);
    items.incomplete.preset = is_header_invalid;
    let preset = preset.unwrap_or_default();
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
    if let Some(TokenTree::Ident(keyword)) = cursor.peek()
        && matches!(cursor.peek_second(), Some(TokenTree::Ident(_)))
        && nearest_name(&keyword.to_string(), &["buffer"]).is_some()
    {
        // The rest is checked as if the keyword were right.
        report.error(
            codes::MISSING_BUFFER,
            &span,
            format!("expected `buffer`, found {found}"),
            "did you mean `buffer`?",
        );
        cursor.take();
        return Some(());
    }
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
        if let Some(TokenTree::Literal(quoted)) = cursor.peek() {
            let name = names::upper_camel(quoted.to_string().trim_matches('"'));
            let help = format!("a name is one word without quotes: write `buffer {name}`");
            report.error(codes::UNEXPECTED_TOKEN, &span, message, help);
            cursor.take();
            return Spanned::new(name, span);
        }
        report.error(codes::UNEXPECTED_TOKEN, &span, message, "write `buffer Name { … }`");
        return Spanned::new("Unnamed".to_string(), span);
    };
    let name = names::written(&name, report);
    if let Some(words) = further_words(cursor) {
        let name = names::upper_camel(&format!("{} {}", name.value, words.join(" ")));
        let (span, message) =
            (cursor.source_span(report), format!("expected `from` or `{{`, found {}", cursor.describe()));
        let help = format!("a name is one word: write `buffer {name}`");
        report.error(codes::UNEXPECTED_TOKEN, &span, message, help);
        while !cursor.is_done() && !is_end_of_name(cursor) {
            cursor.take();
        }
        return Spanned::new(name, span);
    }
    names::buffer(&name, report)
}

/// Returns whether the name of a buffer ends here: at `from`, `:` or a block.
fn is_end_of_name(cursor: &Cursor) -> bool {
    cursor.at_keyword("from") || cursor.at_punct(':') || matches!(cursor.peek(), Some(TokenTree::Group(_)))
}

/// Returns the further words of a name that is more than one word: `My Heat`, `My-Heat`, `my heat from`. A lower-case word before a block
/// may be a technique without `from`.
fn further_words(cursor: &Cursor) -> Option<Vec<String>> {
    let before_end = cursor.rest().iter().take_while(|token| {
        matches!(token, TokenTree::Ident(word) if word != "from")
            || matches!(token, TokenTree::Punct(punct) if punct.as_char() == '-')
            || matches!(token, TokenTree::Literal(number) if number.to_string().starts_with(|digit: char| digit.is_ascii_digit()))
    });
    let tokens: Vec<&TokenTree> = before_end.collect();
    let words: Vec<String> =
        tokens.iter().filter(|token| !matches!(token, TokenTree::Punct(_))).map(ToString::to_string).collect();
    let is_upper = words.first()?.starts_with(|first: char| first.is_ascii_uppercase() || first.is_ascii_digit());
    let is_hyphenated = matches!(tokens.first(), Some(TokenTree::Punct(_)));
    let is_before_from = matches!(cursor.rest().get(tokens.len()), Some(TokenTree::Ident(_)));
    (is_upper || is_hyphenated || is_before_from).then_some(words)
}

/// Parses `from technique`. `Err`: it has an error and is not known.
fn preset(cursor: &mut Cursor, report: &mut Report) -> Result<Option<Spanned<String>>, Stop> {
    if !cursor.take_keyword("from") && !without_from(cursor, report) {
        return Ok(None);
    }
    let span = cursor.source_span(report);
    match cursor.take_identifier() {
        Some(name) => Ok(Some(Spanned::new(hyphenated(name.to_string(), cursor, report), span))),
        None => {
            if let Some(TokenTree::Literal(quoted)) = cursor.peek() {
                let name = quoted.to_string().trim_matches('"').to_owned();
                let message = format!("expected a technique name after `from`, found {}", cursor.describe());
                let help = format!("write the name without quotes: `from {name}`");
                report.error(codes::UNEXPECTED_TOKEN, &span, message, help);
                cursor.take();
                return Ok(Some(Spanned::new(name, span)));
            }
            let message = format!("expected a technique name after `from`, found {}", cursor.describe());
            report.error(codes::UNEXPECTED_TOKEN, &span, message, "for example `from kplus_array`");
            Err(Stop)
        }
    }
}

/// Takes the rest of a name that is written with `-` in place of `_`, which is an error, and returns the whole name.
fn hyphenated(mut name: String, cursor: &mut Cursor, report: &mut Report) -> String {
    let span = cursor.source_span(report);
    while cursor.at_punct('-') && matches!(cursor.peek_second(), Some(TokenTree::Ident(_))) {
        cursor.take();
        name.extend(cursor.take_identifier().map(|part| format!("_{part}")));
    }
    if name.contains('_') && cursor.source_span(report) != span {
        let help = format!("names have `_` in place of `-`: write `from {name}`");
        report.error(codes::UNEXPECTED_TOKEN, &span, "expected `{`, found `-`", help);
    }
    name
}

/// Reports a technique without `from`, or after another word. Moves to the technique, and returns whether there is one.
fn without_from(cursor: &mut Cursor, report: &mut Report) -> bool {
    let (span, found) = (cursor.source_span(report), cursor.describe());
    let Some(TokenTree::Ident(word)) = cursor.peek() else { return false };
    let word = word.to_string();
    let technique = match cursor.peek_second() {
        Some(TokenTree::Ident(technique)) => Some(technique.to_string()),
        _ => None,
    };
    let help = match &technique {
        Some(_) if nearest_name(&word, &["from"]).is_some() => "did you mean `from`?".to_owned(),
        Some(technique) => format!("write `from {technique}`"),
        None => format!("write `from {word}` to start from this technique; the name of a buffer is one word"),
    };
    if technique.is_some() {
        cursor.take();
    }
    report.error(codes::UNEXPECTED_TOKEN, &span, format!("expected `from` or `{{`, found {found}"), help);
    true
}

fn body(cursor: &mut Cursor, report: &mut Report) -> Option<Group> {
    if let Some(group) = cursor.take_braces() {
        return Some(group);
    }
    cursor.expected("`{`", "write `buffer Name from kplus_array { … }`", report);
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
