//! A choice that is given outside of a description, as the argument of `--set`.
//!
//! Input: the value after the `=`. Output: the choice by the grammar of descriptions, with spans inside of the argument. A path that ends
//! in `.wgsl` needs neither quotes nor `wgsl(…)`: shells remove quotes.

use fragbuf_model::{Choice, Diagnostics, SourceSpan, Spanned};
use proc_macro2::Span;

use crate::report::Report;
use crate::{grammar, lexer, token_limits};

/// Parses the alternatives of a choice: `spin_lock { limit: 4 } else interlock`, `mine.wgsl`. `start` is the position of the value.
pub fn choice(axis: &Spanned<String>, value: &str, start: &SourceSpan) -> Result<Choice, Diagnostics> {
    let quoted = QuotedPaths::of(value);
    let inner = lexer::locator(&quoted.text, &start.file);
    let locate = |span: Span| quoted.in_value(&inner(span), start);
    let tokens = lexer::tokens(&quoted.text, &start.file).map_err(|invalid| {
        let mut invalid = *invalid;
        invalid.span = quoted.in_value(&invalid.span, start);
        Diagnostics::from(invalid)
    })?;
    let mut report = Report::new(&locate);
    let tokens = token_limits::bounded(tokens, &mut report);
    let choice = tokens.and_then(|tokens| grammar::alternatives(axis, tokens, &mut report).ok());
    let errors = report.finish();
    match choice {
        Some(choice) if errors.is_empty() => Ok(choice),
        _ => Err(errors),
    }
}

/// A value whose paths are in quotes, as in a description.
struct QuotedPaths {
    text: String,
    /// The column of each character of `text` in the value, from 0.
    columns: Vec<u32>,
}

impl QuotedPaths {
    fn of(value: &str) -> Self {
        let mut quoted = QuotedPaths { text: String::new(), columns: Vec::new() };
        let mut column = 0;
        for (index, alternative) in value.split(" else ").enumerate() {
            if index > 0 {
                quoted.push(" else ", &mut column);
            }
            // Options follow in braces.
            let (name, options) = alternative.split_at(alternative.find('{').unwrap_or(alternative.len()));
            match path(name) {
                Some(path) => {
                    let (before, after) = name.split_once(path).unwrap_or((name, ""));
                    column += before.chars().count() as u32;
                    quoted.insert("wgsl(\"", column);
                    quoted.push(path, &mut column);
                    quoted.insert("\")", column);
                    column += after.chars().count() as u32;
                }
                None => quoted.push(name, &mut column),
            }
            quoted.push(options, &mut column);
        }
        quoted
    }

    fn push(&mut self, text: &str, column: &mut u32) {
        self.text.push_str(text);
        self.columns.extend(text.chars().zip(*column..).map(|(_, column)| column));
        *column += text.chars().count() as u32;
    }

    /// Adds characters that the value does not have.
    fn insert(&mut self, text: &str, column: u32) {
        self.text.push_str(text);
        self.columns.extend(text.chars().map(|_| column));
    }

    /// Returns the span in the argument for one in `text`.
    fn in_value(&self, span: &SourceSpan, start: &SourceSpan) -> SourceSpan {
        let end = self.columns.last().map_or(0, |last| last + 1);
        let column = |at: u32| self.columns.get(at as usize).copied().unwrap_or(end);
        let first = span.column.saturating_sub(1);
        let (begin, stop) = (column(first), column(first + span.length));
        SourceSpan::new(start.file.clone(), start.line, start.column + begin).with_length(stop.saturating_sub(begin))
    }
}

/// Returns the path of a user file that is not in quotes: `mine.wgsl`, or `wgsl(mine.wgsl)`.
fn path(name: &str) -> Option<&str> {
    let name = name.trim();
    let inner = name.strip_prefix("wgsl(").and_then(|rest| rest.strip_suffix(')')).map(str::trim);
    let path = inner.unwrap_or(name);
    (path.ends_with(".wgsl") && !path.contains('"')).then_some(path)
}
